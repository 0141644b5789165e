// SPDX-License-Identifier: MIT
// An invented third drive: what a new profile has to bring is one folder (here: this file) and one line in profiles.hpp
// (here: the pointer). Everything else reads it through DriveProfile and DriveSession.
#include <gtest/gtest.h>

#include "decoder/profiles/drive_base.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/drive_bench.hpp"

namespace servotrace {
namespace {

constexpr Field kSpindleFields[] = {
    {.key = "speed",
     .label = "Speed",
     .first_bit = at(0),
     .width = 16,
     .role = Role::kSignal,
     .unit = Unit::kRevolutionsPerMinute,
     .section = "invented 1"},
    {.key = "runs", .label = "Runs", .first_bit = at(2), .width = 1, .kind = Kind::kBool, .section = "invented 1"},
    {.key = "reserved",
     .label = "(reserved)",
     .first_bit = at(2, 1),
     .width = 7,
     .reserved = true,
     .section = "invented 1"},
};
constexpr Layout kSpindle{.protocol = "spindle",
                          .key = "status",
                          .title = "Status",
                          .size = 3,
                          .fields = kSpindleFields,
                          .section = "invented 1"};
static_assert(well_formed(kSpindle));

class SpindleSession final : public DriveBase {
 public:
  using DriveBase::DriveBase;
  void on_command(const Context&, const Message&) override {}
  void on_response(const Context& context, const Message& message) override {
    add(context, message, kSpindle, 0, Direction::kResponse);
    runs_ = read(slot(kSpindle, "runs"), message.bytes) != 0;
  }
  void on_explicit(const Context&, const ExplicitExchange&) override {}
  void on_time(const Context&) override {}
  void on_start(const Context&) override { runs_ = false; }
  void on_gap() override {}
  void on_finish(const Context&) override {}
  bool is_moving() const override { return runs_; }
  void summarise(NodeSummary&, std::vector<Statistic>&) const override {}

 private:
  bool runs_ = false;
};

std::unique_ptr<DriveSession> make_spindle(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only) {
  return std::make_unique<SpindleSession>(settings, node, owner, decode_only);
}
constexpr const Layout* kSpindleLayouts[] = {&kSpindle};
constexpr DriveProfile kSpindleProfile{.key = "invented-spindle",
                                       .title = "Invented spindle",
                                       .protocol = "spindle",
                                       .response_size = 3,
                                       .layouts = kSpindleLayouts,
                                       .make_session = &make_spindle};

TEST(ThirdProfile, IsOneFolderAndOneLine) {
  const DriveProfile* const profiles[] = {&kSpindleProfile};  // the line
  test::DriveBench bench(*profiles[0]);
  bench.response(test::hex("E8 03 01"));
  EXPECT_TRUE(bench.session().is_moving());
  ASSERT_EQ(bench.dissection().segments.size(), 1U);
  EXPECT_EQ(bench.dissection().segments[0].layout, &kSpindle);
  bench.start();
  EXPECT_FALSE(bench.session().is_moving());
}

}  // namespace
}  // namespace servotrace
