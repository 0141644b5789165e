// SPDX-License-Identifier: MIT
#include "decoder/core/slot.hpp"
#include "decoder/profiles/drive_base.hpp"
#include "tests/unit/profiles/invented_spindle/profile.hpp"
#include "tests/unit/profiles/invented_spindle/rules.hpp"

namespace servotrace::spindle {
namespace {

class Session final : public DriveBase {
 public:
  using DriveBase::DriveBase;
  void on_command(const Context&, const Message&) override {}
  void on_response(const Context& context, const Message& message) override {
    add(context, message, kStatus, 0, Direction::kResponse);
    runs_ = read(slot(kStatus, "runs"), message.bytes) != 0;
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

}  // namespace

const DriveProfile& Profile::row() { return kProfile; }

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only) {
  return std::make_unique<Session>(settings, node, owner, decode_only);
}

}  // namespace servotrace::spindle
