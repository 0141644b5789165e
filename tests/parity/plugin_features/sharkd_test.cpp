// SPDX-License-Identifier: MIT
// What the window does and tshark cannot: two files in turn, a reload, frames backwards. sharkd is Wireshark without
// its window. A file says the same whatever was open before it, and a frame whatever was looked at before it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "tests/support/paths.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;

class Sharkd {
 public:
  explicit Sharkd(const Tshark& tshark) : tshark_(tshark) {}
  // The place of the answer.
  std::size_t ask(const std::string& method, const std::string& parameters) {
    requests_ += R"({"jsonrpc":"2.0","id":)" + std::to_string(++count_) + R"(,"method":")" + method +
                 R"(","params":{)" + parameters + "}}\n";
    return count_;
  }
  std::size_t load(const std::string& file) { return ask("load", R"("file":")" + file + '"'); }
  std::size_t frame(unsigned number) {
    return ask("frame", R"("frame":)" + std::to_string(number) + R"(,"proto":true,"bytes":true)");
  }
  // Answers by place, without their ids.
  std::map<std::size_t, std::string> answers() const {
    const auto file = tshark_.folder() / "requests.json";
    std::ofstream(file) << requests_;
    const Ran ran = tshark_.run({"-c", "exec sharkd - <requests.json"}, "sh");
    EXPECT_EQ(ran.status, 0) << ran.err;
    std::map<std::size_t, std::string> result;
    for (const std::string& line : parts_of(ran.out, '\n')) {
      constexpr std::string_view kHead = R"({"jsonrpc":"2.0","id":)";
      if (line.rfind(kHead, 0) != 0) continue;
      std::size_t digits = 0;
      const std::size_t id = std::stoul(line.substr(kHead.size()), &digits);
      result[id] = line.substr(kHead.size() + digits);
    }
    EXPECT_EQ(result.size(), count_);
    return result;
  }

 private:
  const Tshark& tshark_;
  std::string requests_;
  std::size_t count_ = 0;
};

TEST(PluginInAWindow, TwoFilesInTurnAndFramesBackwards) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  if (tshark.run({"-c", "command -v sharkd"}, "sh").status != 0) GTEST_SKIP() << "there is no sharkd";
  const std::string ring = tshark.copy(source_dir() / "captures" / "lost_update.pcapng").string();
  const std::string bus = tshark.copy(source_dir() / "captures" / "ns310_clean.pcapng").string();
  Sharkd sharkd(tshark);
  struct Looks {
    std::size_t findings, later, earlier, again;
  };
  const auto look = [&sharkd](unsigned later, unsigned earlier) {
    return Looks{sharkd.ask("frames", R"("filter":"servotrace || dnet.response_in")"), sharkd.frame(later),
                 sharkd.frame(earlier), sharkd.frame(later)};
  };
  sharkd.load(ring);
  const Looks first = look(279, 1);
  sharkd.load(bus);
  const Looks other = look(14, 12);  // a message of two fragments, and the first of them
  sharkd.load(ring);
  const Looks second = look(279, 1);
  sharkd.load(ring);  // the same once more
  const Looks third = look(279, 1);
  sharkd.load(bus);
  const Looks other_again = look(14, 12);

  const auto answers = sharkd.answers();
  const auto at = [&answers](std::size_t id) {
    const auto found = answers.find(id);
    return found == answers.end() ? std::string("no answer") : found->second;
  };
  EXPECT_THAT(at(first.findings), HasSubstr("\"num\":279"));
  EXPECT_THAT(at(first.later), HasSubstr("RX201"));
  EXPECT_THAT(at(other.later), HasSubstr("Reassembled message"));
  EXPECT_THAT(at(other.earlier), HasSubstr("Reassembled in: 14"));
  for (const Looks* looks : {&first, &second, &third, &other, &other_again})
    EXPECT_EQ(at(looks->later), at(looks->again));
  for (const Looks* looks : {&second, &third}) {
    EXPECT_EQ(at(looks->findings), at(first.findings));
    EXPECT_EQ(at(looks->later), at(first.later));
    EXPECT_EQ(at(looks->earlier), at(first.earlier));
  }
  EXPECT_EQ(at(other_again.findings), at(other.findings));
  EXPECT_EQ(at(other_again.later), at(other.later));
  EXPECT_EQ(at(other_again.earlier), at(other.earlier));
}

}  // namespace
}  // namespace servotrace::test
