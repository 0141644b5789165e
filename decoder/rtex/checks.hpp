// SPDX-License-Identifier: MIT
// The checks of the RX rules; each stands in the checks_*.cpp file of its block.
#pragma once

#include "decoder/rtex/events.hpp"

namespace servotrace::rtex {

namespace checks {
// checks_header.cpp: RX1
Outcome communication_error(Scene& scene);
Outcome mac_id_mismatch(Scene& scene);
Outcome command_cr_set(Scene& scene);
Outcome response_cr_clear(Scene& scene);
Outcome cyclic_code_undefined(Scene& scene);
Outcome unused_bit_set(Scene& scene);
Outcome sub_chk_clear(Scene& scene);
Outcome response_missing(Scene& scene);
Outcome communication_errors_sustained(Scene& scene);
Outcome too_many_axes(Scene& scene);
Outcome mac_id_duplicate(Scene& scene);
// checks_handshake.cpp: RX3
Outcome not_from_standard(Scene& scene);
Outcome not_held_until_echo(Scene& scene);
Outcome started_while_busy(Scene& scene);
Outcome left_while_busy(Scene& scene);
Outcome argument_change_ignored(Scene& scene);
Outcome non_cyclic_undefined(Scene& scene);
// checks_mode.cpp: RX4
Outcome mode_change_not_normal(Scene& scene);
Outcome mode_change_while_busy(Scene& scene);
Outcome mode_change_too_soon(Scene& scene);
Outcome nop_after_start(Scene& scene);
// checks_report.cpp: RX9
Outcome command_error(Scene& scene);
Outcome alarm(Scene& scene);
// checks_arguments.cpp, checks_motion.cpp and the other blocks, in the order of the rules
Outcome non_cyclic_not_in_mode(Scene& scene);
Outcome type_code_undefined(Scene& scene);
Outcome argument_out_of_range(Scene& scene);
Outcome data3_not_zero(Scene& scene);
Outcome echo_missing(Scene& scene);
Outcome busy_long(Scene& scene);
Outcome result_not_read(Scene& scene);
Outcome sub_data_not_zero(Scene& scene);
Outcome echo_arguments(Scene& scene);
Outcome mode_change_in_profile(Scene& scene);
Outcome mode_change_to_cp_moving(Scene& scene);
Outcome mode_change_to_pp_normal(Scene& scene);
Outcome mode_full_closed(Scene& scene);
Outcome mode_not_in_cycle(Scene& scene);
Outcome mode_change_in_homing(Scene& scene);
Outcome homing_servo_off(Scene& scene);
Outcome homing_in_cv_ct(Scene& scene);
Outcome homing_abandoned(Scene& scene);
Outcome multi_turn_servo_on(Scene& scene);
Outcome multi_turn_short(Scene& scene);
Outcome homing_in_profile_latch(Scene& scene);
Outcome homing_in_profile(Scene& scene);
Outcome profile_type_changed(Scene& scene);
Outcome profile_before_home(Scene& scene);
Outcome profile_negative_speed(Scene& scene);
Outcome profile_unused_not_zero(Scene& scene);
Outcome homing_in_pp(Scene& scene);
Outcome profile_start_blocked(Scene& scene);
Outcome reset_before_all_echoed(Scene& scene);
Outcome reset_servo_on(Scene& scene);
Outcome validation_servo_on(Scene& scene);
Outcome servo_on_in_validation(Scene& scene);
Outcome parameter_clipped(Scene& scene);
Outcome a4n_parameter_code(Scene& scene);
Outcome parameter_protected(Scene& scene);
Outcome servo_on_not_ready(Scene& scene);
Outcome servo_off_in_progress(Scene& scene);
Outcome servo_on_while_turning(Scene& scene);
Outcome warning(Scene& scene);
Outcome processing_error(Scene& scene);
Outcome processing_warning(Scene& scene);
Outcome torque_limited(Scene& scene);
Outcome home_lost(Scene& scene);
Outcome servo_dropped(Scene& scene);
// checks_position.cpp, checks_homing.cpp, checks_profile.cpp, checks_parameters.cpp, timing.cpp
Outcome tmg_cnt_period(Scene& scene);
Outcome tmg_cnt_axes(Scene& scene);
Outcome tmg_cnt_unused(Scene& scene);
Outcome mode_change_velocity(Scene& scene);
Outcome homing_position_not_set(Scene& scene);
Outcome position_set_moving(Scene& scene);
Outcome profile_update_ignored(Scene& scene);
Outcome profile_relative_changed(Scene& scene);
Outcome software_limit(Scene& scene);
Outcome homing_on_inhibit_input(Scene& scene);
Outcome position_set_in_motion(Scene& scene);
Outcome multi_turn_no_power_cycle(Scene& scene);
Outcome profile_not_resumed(Scene& scene);
Outcome homing_not_for_encoder(Scene& scene);
Outcome latch_read_early(Scene& scene);
Outcome latch_cancelled(Scene& scene);
Outcome profile_never_ends(Scene& scene);
Outcome profile_not_started(Scene& scene);
Outcome eeprom_wear(Scene& scene);
Outcome parameter_while_moving(Scene& scene);
Outcome parameter_value_forbidden(Scene& scene);
Outcome reset_without_eeprom(Scene& scene);
Outcome parameter_differs_from_ring(Scene& scene);
Outcome servo_on_position_jump(Scene& scene);
Outcome position_step(Scene& scene);
Outcome drive_inhibit(Scene& scene);
Outcome command_while_off(Scene& scene);
Outcome emergency_stop(Scene& scene);
}  // namespace checks

}  // namespace servotrace::rtex
