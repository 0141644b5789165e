// SPDX-License-Identifier: MIT
// The text that JUnit keeps until its counts are known comes out as it went in, however much it is.
#include <gtest/gtest.h>

#include "replay/output/spool.hpp"

namespace servotrace::test {
namespace {

class Text : public replay::Out {
 public:
  void write(std::string_view text) override { all += text; }
  Result<void> finish() override { return {}; }
  std::string all;
};

TEST(Spool, GivesBackWhatItTook) {
  for (const std::size_t most : {std::size_t{0}, std::size_t{7}, std::size_t{1000}, std::size_t{1} << 20U}) {
    replay::Spool spool(most);
    std::string expected;
    for (int i = 0; i < 20000; ++i) {
      const std::string line = "line " + std::to_string(i) + "\n";
      spool.write(line);
      expected += line;
    }
    Text text;
    spool.copy_to(text);
    EXPECT_EQ(text.all, expected) << most;
  }
}

TEST(Spool, IsEmptyAtFirst) {
  Text text;
  replay::Spool().copy_to(text);
  EXPECT_EQ(text.all, "");
}

}  // namespace
}  // namespace servotrace::test
