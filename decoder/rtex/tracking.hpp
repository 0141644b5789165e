// SPDX-License-Identifier: MIT
// What commands and answers say about the drive: parameters, alarms, homing, latch and profile, strings.
#pragma once

#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex {

// Before the checks of a command block, and after those of a response block: watch.cpp.
void watch_command(Scene& scene);
void watch_following(Scene& scene);
// After the checks of a command block.
void track_command(Scene& scene);
// After a channel's handshake took a command block: shows how far its command is.
void show_handshake(Scene& scene);
// After the checks of an answer of scene.channel; `completed`: the first complete answer of the held command.
void track_answer(Scene& scene, bool completed);
// An answer of the alarm command: gives RX902 and RX903 the code they were said without (checks_report.cpp).
void track_alarm_code(Scene& scene);
// After the checks of a response block.
void track_status(Scene& scene);
// The part of it that follows what is measured.
void watch_values(Scene& scene);
// Puts the status and Response_Data1 of `last` into `response`, zero where there is none.
void keep_status(ResponseView& response, const ResponseView& last, bool known);

}  // namespace servotrace::rtex
