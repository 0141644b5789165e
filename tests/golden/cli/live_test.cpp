// SPDX-License-Identifier: MIT
// Live traffic in a network namespace of the test's own: RTEX records in Ethernet frames over a veth pair and in UDP
// over loopback, findings as they happen, the summary on Ctrl-C. Skipped where the machine grants no namespace.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "replay/capture/source.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

// Sends the frames of a file (length in two bytes, then the bytes) at a pace a loaded machine can follow.
constexpr const char* kSender = R"(import socket, struct, sys, time
kind, interface, path = sys.argv[1:]
data = open(path, 'rb').read()
if kind == 'ethernet':
  out = socket.socket(socket.AF_PACKET, socket.SOCK_RAW)
  out.bind((interface, 0))
  send = out.send
else:
  out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
  send = lambda frame: out.sendto(frame[28:], ('127.0.0.1', 35224))
at = 0
while at < len(data):
  size, = struct.unpack_from('>H', data, at)
  send(data[at + 2:at + 2 + size])
  at += 2 + size
  time.sleep(0.0005)
)";

class Live : public ::testing::TestWithParam<std::pair<std::string, std::string>> {
 protected:
  // The frames of a capture as kSender reads them.
  void write_frames(const std::string& capture) const {
    auto source = replay::open_capture(program.folder() / capture);
    ASSERT_TRUE(source) << source.error().text();
    std::string text;
    RawFrame frame;
    while ((*source)->next(frame) == replay::Source::Step::kFrame) {
      text += static_cast<char>(frame.bytes.size() >> 8U);
      text += static_cast<char>(frame.bytes.size() & 0xFFU);
      text.append(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
    }
    program.write("frames.bin", text);
  }
  Program program;
};

TEST_P(Live, FindingsAsTheyHappenAndASummaryOnCtrlC) {
  if (program.shell("unshare -rn ip link add sv0 type veth peer name sv1").status != 0) {
    GTEST_SKIP() << "this machine grants no network namespace with a veth pair";
  }
  const auto& [carrier, interface] = GetParam();
  program.simulate("rx202_update_counter_skip", "run");
  ASSERT_EQ(program.run({"convert", "run.pcapng", "-o", "carried.pcapng", "--carrier", carrier}).status, 0);
  write_frames("carried.pcapng");
  program.write("send.py", kSender);
  // The sender sleeps as a loaded machine lets it: a pause is no lost ring here (RX112 starts it anew).
  program.write("servotrace.toml", "[limits]\ntimeout_cycles = 100000\n");
  program.write("live.sh",
                "ip link set lo up && ip link add sv0 type veth peer name sv1 &&\n"
                "ip link set sv0 up && ip link set sv1 up || exit 77\n"
                "servotrace check --interface " +
                    interface +
                    " --select RX202 --output text --output jsonl=live.jsonl 2>live.err & pid=$!\n"
                    "for i in $(seq 200); do grep -q Ctrl-C live.err && break; sleep 0.05; done\n"
                    "sleep 0.2; python3 send.py " +
                    carrier +
                    " sv0 frames.bin\n"
                    "for i in $(seq 100); do grep -q RX202 live.err && break; sleep 0.05; done\n"
                    "grep -q RX202 live.err && echo seen before the end\n"
                    "kill -INT $pid; wait $pid\n");
  const Outcome outcome = program.shell("unshare -rn bash live.sh");
  const std::string said = program.read("live.err");
  if (said.find("cannot be captured from") != std::string::npos) GTEST_SKIP() << said;
  EXPECT_EQ(outcome.status, 1) << outcome.err << said;
  EXPECT_THAT(outcome.out, HasSubstr("seen before the end\n"));
  EXPECT_THAT(said, HasSubstr(" error[RX202] axis 1: Update_Counter went from 2 to 0\n"));
  EXPECT_THAT(outcome.out, HasSubstr("error[RX202] axis 1: Update_Counter went from 2 to 0"));
  EXPECT_THAT(outcome.out, HasSubstr("findings: 1 error, 0 warnings, 0 notes in "));
  EXPECT_THAT(program.read("live.jsonl"), EndsWith("\"captures\":1,\"exit_status\":1}\n"));
}

INSTANTIATE_TEST_SUITE_P(Carriers, Live,
                         ::testing::Values(std::pair<std::string, std::string>("ethernet", "sv1"),
                                           std::pair<std::string, std::string>("udp", "lo")),
                         [](const auto& entry) { return entry.param.first; });

TEST(LiveErrors, AnInterfaceThatIsNotThereIsOneLineAndTwo) {
  const Program program;
  const Outcome outcome = program.run({"check", "--interface", "nosuch0", "--output", "jsonl=out.jsonl"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("servotrace: nosuch0: cannot be captured from: "));
  EXPECT_FALSE(program.exists("out.jsonl"));
}

}  // namespace
}  // namespace servotrace::test
