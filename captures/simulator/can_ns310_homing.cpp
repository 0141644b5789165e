// SPDX-License-Identifier: MIT
// Homing types 0, 1 and 3 (SIE-C718-7 4.3.2, 5.4.3).
#include <algorithm>

#include "captures/simulator/can_ns310.hpp"

namespace servotrace::simulator {

bool Ns310::at_home_switch() const {
  return axis_.position() <= home_switch_ && axis_.position() >= home_switch_ - home_width_;
}

bool Ns310::passed_phase_c(std::int64_t from, std::int64_t to) const {
  const auto turn = [&](std::int64_t position) {
    return position >= 0 ? position / phase_c_distance_ : -((-position - 1) / phase_c_distance_) - 1;
  };
  return from != to && turn(from) != turn(to);
}

void Ns310::start_homing(std::uint8_t type) {
  homing_type_ = type;
  homed_ = false;
  homing_ = type == 3 ? Homing::kPhaseC : Homing::kApproach;
  const std::int64_t sign = parameter(0x25, 253) != 0 ? 1 : -1;
  axis_.turn(sign * parameter(0x25, 254));
}

void Ns310::tick_homing() {
  const std::int64_t sign = parameter(0x25, 253) != 0 ? 1 : -1;
  switch (homing_) {
    case Homing::kApproach:
      if (!at_home_switch()) return;
      homing_mark_ = axis_.position();
      if (homing_type_ == 1) {
        homing_ = Homing::kReturn;
        axis_.move_to(homing_mark_, parameter(0x25, 255));
      } else {
        homing_ = Homing::kBack;
        axis_.turn(-sign * parameter(0x25, 255));
      }
      return;
    case Homing::kBack:
      if (!at_home_switch() && axis_.speed() * sign < 0) homing_ = Homing::kPhaseC;
      return;
    case Homing::kReturn:
      if (!axis_.moving()) finish_homing();
      return;
    case Homing::kPhaseC:
    case Homing::kNone:
      return;
  }
}

void Ns310::finish_homing() {
  homing_ = Homing::kNone;
  homed_ = true;
  home_switch_ -= homing_mark_;
  axis_.set_position(0);
}

}  // namespace servotrace::simulator
