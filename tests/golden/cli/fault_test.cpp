// SPDX-License-Identifier: MIT
// What goes wrong outside: full disks, closed pipes, input that breaks in the middle, a process that is killed. Always
// a message and status 2, and nothing half-written under its final name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Fault : public ::testing::Test {
 protected:
  void SetUp() override { program.simulate("rtex_clean", "run"); }
  // What lies in the folder, by name.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(program.folder()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  Program program;
};

TEST_F(Fault, StandardOutputIsFull) {
  for (const char* arguments : {"decode run.pcapng", "decode run.pcapng --format jsonl", "info run.pcapng", "rules",
                                "explain RX201", "config --init run.pcapng", "check run.pcapng --output json"}) {
    const Outcome outcome = program.shell(std::string("servotrace ") + arguments + " >/dev/full");
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device")) << arguments;
  }
}

TEST_F(Fault, ThePipeIsClosed) {
  for (const char* arguments : {"decode run.pcapng --format jsonl", "rules", "check run.pcapng --output json"}) {
    const Outcome outcome =
        program.shell(std::string("servotrace ") + arguments + " | head -c 1 >/dev/null; echo ${PIPESTATUS[0]}");
    EXPECT_EQ(outcome.out, "0\n") << arguments;
    EXPECT_THAT(outcome.err, IsEmpty()) << arguments;
  }
}

// The shell allows files of one block only: a disk that fills up while a file is written.
TEST_F(Fault, TheDiskFillsUp) {
  for (const char* arguments :
       {"report run.pcapng -o out.html", "convert run.pcapng -o out.pcapng", "export run.pcapng -o out.csv",
        "check run.pcapng --output text --output json=out.json", "annotate run.pcapng -o out.pcapng"}) {
    const Outcome outcome = program.shell(std::string("trap '' XFSZ; ulimit -f 1; servotrace ") + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("cannot be written: File too large")) << arguments;
    EXPECT_THAT(files(), ElementsAre("run.pcapng")) << arguments;
  }
}

TEST_F(Fault, KilledBetweenTwoWritesNothingHasItsFinalName) {
  // The fifo gives the first half and then stays open: the program waits in the middle of its work.
  const Outcome outcome = program.shell(
      "mkfifo pipe; half=$(($(stat -c %s run.pcapng) / 2)); (head -c $half run.pcapng; sleep 20) >pipe & feeder=$!; "
      "servotrace convert - -o out.pcapng <pipe & program=$!; "
      "for i in $(seq 100); do ls .out.pcapng.*.tmp >/dev/null 2>&1 && break; sleep 0.1; done; sleep 0.2; "
      "ls .out.pcapng.*.tmp >/dev/null && echo begun; kill -9 $program; wait $program; "
      "kill $feeder 2>/dev/null; rm -f pipe .out.pcapng.*.tmp; true");
  EXPECT_THAT(outcome.out, HasSubstr("begun"));
  EXPECT_FALSE(program.exists("out.pcapng"));
}

// A directory can be opened and not read: the nearest to a failing disk.
TEST_F(Fault, StandardInputCannotBeRead) {
  for (const char* arguments : {"check -", "decode -", "info -", "convert - -o out.pcapng"}) {
    const Outcome outcome = program.shell(std::string("servotrace ") + arguments + " <.");
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("Is a directory")) << arguments;
    EXPECT_THAT(files(), ElementsAre("run.pcapng")) << arguments;
  }
}

class BrokenStream : public Fault, public ::testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    Fault::SetUp();
    const std::string tool = GetParam();
    const Outcome made = program.shell(tool +
                                       " -q -k run.pcapng; packed=$(ls run.pcapng.*); "
                                       "head -c $(($(stat -c %s $packed) / 2)) $packed >cut.packed; "
                                       "rm $packed run.pcapng");
    ASSERT_EQ(made.status, 0) << made.err;
  }
};

TEST_P(BrokenStream, IsAMessageAndTwo) {
  for (const char* arguments : {"check cut.packed", "check - <cut.packed", "decode cut.packed", "info cut.packed",
                                "check cut.packed --output text --output jsonl=found.jsonl"}) {
    const Outcome outcome = program.shell(std::string("servotrace ") + arguments + " >out");
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("stream ends early")) << arguments;
  }
}

// What could be read is no whole file: neither a new one nor one in place of the old.
TEST_P(BrokenStream, NoFileIsMadeOfHalf) {
  for (const char* arguments : {"convert cut.packed -o out.pcapng", "annotate cut.packed -o out.pcapng",
                                "export cut.packed -o out.csv", "export cut.packed -o out.pftrace"}) {
    const std::string name = std::string(arguments).substr(std::string(arguments).rfind(' ') + 1);
    for (const bool is_old : {false, true}) {
      if (is_old) program.write(name, "as it was");
      const Outcome outcome = program.shell(std::string("servotrace ") + arguments);
      EXPECT_EQ(outcome.status, 2) << arguments;
      EXPECT_THAT(outcome.err, HasSubstr("stream ends early")) << arguments;
      // The half of the zstd file is too short to be begun with: no output was thought of yet.
      if (std::string_view(GetParam()) == "gzip") {
        EXPECT_THAT(outcome.err, HasSubstr("; " + name + " is not written\n")) << arguments;
      }
      if (is_old) {
        EXPECT_EQ(program.read(name), "as it was") << arguments;
        std::filesystem::remove(program.folder() / name);
      }
      EXPECT_THAT(files(), ElementsAre("cut.packed")) << arguments;
    }
  }
}

// A recording that was cut holds whole records: they are a whole file, and the cut is said.
TEST_F(Fault, ARecordingThatWasCutIsConvertedUpToItsLastRecord) {
  ASSERT_EQ(program.shell("head -c -30 run.pcapng > cut.pcapng").status, 0);
  const Outcome outcome = program.run({"convert", "cut.pcapng", "-o", "out.pcapng"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "servotrace: cut.pcapng: ends inside a record: what came before it was converted\n");
  const Outcome read = program.run({"check", "out.pcapng"});
  EXPECT_EQ(read.status, 0) << read.err;
  EXPECT_THAT(read.out, testing::StartsWith("clean: no findings in "));
}

INSTANTIATE_TEST_SUITE_P(All, BrokenStream, ::testing::Values("gzip", "zstd"));

}  // namespace
}  // namespace servotrace::test
