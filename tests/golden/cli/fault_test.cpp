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

// The reader of the pipe cuts the file while the program waits for it: the rest is gone under its hands.
TEST_F(Fault, AFileIsCutWhileItIsRead) {
  const Outcome outcome = program.shell(
      "servotrace decode run.pcapng | (head -c 1; truncate -s 8192 run.pcapng; cat) >out; echo ${PIPESTATUS[0]}");
  EXPECT_EQ(outcome.out, "2\n");
  EXPECT_THAT(outcome.err, HasSubstr("run.pcapng: byte "));
  EXPECT_THAT(outcome.err, HasSubstr("cannot be read on: the file was cut while it was read, or its disk fails\n"));
  EXPECT_THAT(program.read("out"), testing::StartsWith("1 ")) << "what was read before is told";
}

// A connection that is reset in the middle of a capture: what comes before it is judged, and no file is made of it.
TEST_F(Fault, AConnectionIsResetInTheMiddle) {
  if (program.shell("command -v python3").status != 0) GTEST_SKIP() << "no python3 to make the connection";
  program.write("feed.py",
                "import socket, subprocess, sys, threading\n"
                "ours, theirs = socket.socketpair()\n"
                "theirs.sendall(b'x')\n"  // bytes nobody reads make the close a reset
                "def feed():\n"
                "    data = open('run.pcapng', 'rb').read()\n"
                "    ours.sendall(data[:len(data) // 2])\n"
                "    ours.close()\n"
                "thread = threading.Thread(target=feed)\n"
                "thread.start()\n"
                "done = subprocess.run(['servotrace'] + sys.argv[1:], stdin=theirs)\n"
                "thread.join()\n"
                "sys.exit(done.returncode)\n");
  for (const char* arguments :
       {"check -", "decode - --brief", "info -", "convert - -o out.pcapng", "annotate - -o out.pcapng"}) {
    const Outcome outcome = program.shell(std::string("python3 feed.py ") + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("cannot be read on: Connection reset by peer")) << arguments;
    EXPECT_THAT(files(), ElementsAre("feed.py", "run.pcapng")) << arguments;
  }
  const Outcome partial = program.shell("python3 feed.py convert - -o out.pcapng --partial");
  EXPECT_EQ(partial.status, 0) << partial.err;
  EXPECT_THAT(partial.err, HasSubstr("Connection reset by peer; what stands before it was converted\n"));
  EXPECT_THAT(program.run({"check", "out.pcapng"}).out, testing::StartsWith("clean: no findings in "));
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
        EXPECT_THAT(outcome.err, HasSubstr("; " + name + " is not written")) << arguments;
      }
      if (is_old) {
        EXPECT_EQ(program.read(name), "as it was") << arguments;
        std::filesystem::remove(program.folder() / name);
      }
      EXPECT_THAT(files(), ElementsAre("cut.packed")) << arguments;
    }
  }
}

// A recording that was cut, plain or compressed, is no whole file; what it holds is to be had on request.
TEST_F(Fault, ARecordingThatWasCutIsConvertedOnRequest) {
  ASSERT_EQ(program
                .shell("head -c -30 run.pcapng > cut.pcapng; gzip -k run.pcapng; "
                       "head -c -30 run.pcapng.gz > cut.pcapng.gz; rm run.pcapng*")
                .status,
            0);
  const std::vector<std::pair<std::string, std::string>> recordings = {{"cut.pcapng", "ends inside a record"},
                                                                       {"cut.pcapng.gz", "the gzip stream ends early"}};
  for (const auto& [name, why] : recordings) {
    const Outcome refused = program.run({"convert", name, "-o", "out.pcapng"});
    EXPECT_EQ(refused.status, 2) << name;
    EXPECT_THAT(refused.err, HasSubstr(why)) << name;
    EXPECT_THAT(refused.err,
                testing::EndsWith("; out.pcapng is not written (--partial: write what stands before it)\n"));
    EXPECT_THAT(files(), ElementsAre("cut.pcapng", "cut.pcapng.gz"));
    const Outcome outcome = program.run({"convert", name, "-o", "out.pcapng", "--partial"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << name;
    EXPECT_THAT(outcome.err, testing::EndsWith("; what stands before it was converted\n")) << name;
    const Outcome read = program.run({"check", "out.pcapng"});
    EXPECT_EQ(read.status, 0) << read.err;
    EXPECT_THAT(read.out, testing::StartsWith("clean: no findings in ")) << name;
    std::filesystem::remove(program.folder() / "out.pcapng");
  }
}

INSTANTIATE_TEST_SUITE_P(All, BrokenStream, ::testing::Values("gzip", "zstd"));

}  // namespace
}  // namespace servotrace::test
