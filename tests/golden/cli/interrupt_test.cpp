// SPDX-License-Identifier: MIT
// A run that is interrupted: results whole or not at all. A stream that is interrupted ends like a capture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Interrupted : public ::testing::Test {
 protected:
  // A folder whose check takes some seconds.
  void make_many() const {
    program.simulate("rtex_clean", "first");
    std::filesystem::create_directories(program.folder() / "many");
    for (int i = 0; i < 4000; ++i) {
      std::filesystem::create_hard_link(program.folder() / "first.pcapng",
                                        program.folder() / "many" / (std::to_string(i) + ".pcapng"));
    }
  }
  Program program;
};

class InterruptedBy : public Interrupted, public ::testing::WithParamInterface<const char*> {};

TEST_P(InterruptedBy, NoFileAppearsAndNoneIsLeftBehind) {
  make_many();
  program.write("old.xml", "as it was");
  program.write("run.sh",
                std::string("servotrace check many --output jsonl=out.jsonl --output junit=old.xml "
                            "--write-baseline base.json --jobs 2 & pid=$!\n"
                            // The files beside the targets are there once it is at work.
                            "for i in $(seq 400); do ls .out.jsonl.*.tmp >/dev/null 2>&1 && break; sleep 0.01; "
                            "done; sleep 0.1\nkill -") +
                    GetParam() + " $pid; wait $pid\n");
  const Outcome outcome = program.shell("bash run.sh");
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.err, "servotrace: interrupted: the results are not complete, no file was written\n");
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_FALSE(program.exists("out.jsonl"));
  EXPECT_FALSE(program.exists("base.json"));
  EXPECT_EQ(program.read("old.xml"), "as it was");
  EXPECT_EQ(program.shell("ls -A | grep tmp").out, "");
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptedBy, ::testing::Values("INT", "TERM"),
                         [](const auto& entry) { return std::string(entry.param); });

TEST_F(Interrupted, AStreamEndsWithItsSummary) {
  program.simulate("cp102_time_backwards", "run");
  program.write("run.sh",
                "mkfifo pipe\n"
                "servotrace check - --fail-on warning <pipe >out.txt & pid=$!\n"
                // The stream stays open, half a record is on its way.
                "exec 3>pipe; cat run.pcapng >&3; head -c 30 run.pcapng >&3; sleep 0.5\n"
                "kill -INT $pid; wait $pid; echo status $?; cat out.txt\n");
  const Outcome outcome = program.shell("timeout -k 1 20 bash run.sh");
  EXPECT_THAT(outcome.out, StartsWith("status 1\n-:"));
  EXPECT_THAT(outcome.out, HasSubstr("warning[CP102]"));
  EXPECT_THAT(outcome.out, HasSubstr("\nfindings: 0 errors, 1 warning, 0 notes in "));
}

// The fifo gives the first half of a capture and stays open: a named one is a file that was not read to its end, on
// standard input it is a stream that ends here.
TEST_F(Interrupted, AFileIsMadeOfAStreamAndOfAWholeCapture) {
  program.simulate("rtex_clean", "run");
  for (const std::string command : {"convert", "annotate"}) {
    program.write(
        "run.sh",
        "rm -f pipe; mkfifo pipe; (head -c 20000 run.pcapng; sleep 20) >pipe & feeder=$!\n"
        "servotrace " +
            command +
            " $1 -o out.pcapng <${2:-/dev/null} & pid=$!\n"
            "for i in $(seq 100); do ls .out.pcapng.*.tmp >/dev/null 2>&1 && break; sleep 0.05; done; sleep 0.2\n"
            "kill -INT $pid; wait $pid; status=$?; kill $feeder; exit $status\n");
    const Outcome file = program.shell("timeout -k 1 30 bash run.sh pipe");
    EXPECT_EQ(file.status, 2) << command;
    EXPECT_THAT(file.err, HasSubstr("servotrace: interrupted; out.pcapng is not written\n")) << command;
    EXPECT_EQ(program.shell("ls -A | grep out.pcapng").out, "") << command;
    const Outcome stream = program.shell("timeout -k 1 30 bash run.sh - pipe");
    EXPECT_EQ(stream.status, 0) << command << stream.err;
    EXPECT_EQ(program.run({"check", "out.pcapng"}).status, 0) << command;
    std::filesystem::remove(program.folder() / "out.pcapng");
  }
}

TEST_F(Interrupted, AStreamThatBringsNothingSaysSo) {
  const Outcome outcome = program.shell(
      "mkfifo pipe; servotrace check - <pipe & pid=$!; exec 3>pipe; sleep 0.5; kill -INT $pid; wait $pid");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, StartsWith("servotrace: -: was interrupted before anything came\n"));
}

}  // namespace
}  // namespace servotrace::test
