// SPDX-License-Identifier: MIT
// RX1: headers, responses and the ring (SX-DSV02203 2-3, 2-4, 4-2 to 4-5, 6-11).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

constexpr std::uint32_t kStaleResponses = 8;  // byte for byte the same, this one included

}  // namespace

Outcome communication_error(Scene& scene) {
  return scene.node->response.communication_error ? scene.raise({.where = scene.bytes(1, 1)}) : Outcome::kPassed;
}

Outcome mac_id_mismatch(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.answered || !node.mac_known || !node.have_command) return Outcome::kSilent;
  const bool at_command = node.command_frame == scene.now.frame;
  // On a response only where it makes the Actual MAC-ID known: every later command is judged on its own.
  if (!at_command && node.mac_judged) return Outcome::kSilent;
  scene.node->mac_judged = true;
  if (node.command.mac_id == node.actual_mac) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.mac_id, node.actual_mac},
                      .where = scene.bytes(0, 1),
                      .related = {at_command ? node.response_frame : node.command_frame, 0}});
}

Outcome command_cr_set(Scene& scene) {
  return scene.node->command.cr ? scene.raise({.where = scene.bytes(0, 1)}) : Outcome::kPassed;
}

Outcome response_cr_clear(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.answered || node.zero_response) return Outcome::kSilent;  // all zero is RX108
  return !node.response.cr ? scene.raise({.where = scene.bytes(0, 1)}) : Outcome::kPassed;
}

Outcome cyclic_code_undefined(Scene& scene) {
  const std::uint8_t cyclic = scene.node->command.cyclic;
  return cyclic > 4 ? scene.raise({.arguments = {cyclic}, .where = scene.bytes(1, 1)}) : Outcome::kPassed;
}

Outcome unused_bit_set(Scene& scene) {
  const CommandView& command = scene.node->command;
  const bool raised = command.unused_bits != 0 || command.sub_unused != 0;
  const ByteRange where = command.unused_bits != 0 ? scene.bytes(2, 2) : scene.bytes(kSubHeaderAt, 1);
  return raised ? scene.raise(
                      {.arguments = {command.unused_bits & 0xFF, command.unused_bits >> 8, command.sub_unused << 4},
                       .where = where})
                : Outcome::kPassed;
}

Outcome sub_chk_clear(Scene& scene) {
  const CommandView& command = scene.node->command;
  if (!command.wide) return Outcome::kSilent;
  return !command.sub_chk ? scene.raise({.where = scene.bytes(kSubHeaderAt, 1)}) : Outcome::kPassed;
}

Outcome response_missing(Scene& scene) {
  const Node& node = *scene.node;
  if (!scene.ring.running || !node.answered) return Outcome::kSilent;
  if (node.zero_response)
    return scene.raise({.arguments = {1}, .where = scene.bytes(0, node.wide ? 32 : 16), .variant = 1});
  if (!node.synchronised) return Outcome::kPassed;
  if (node.same_responses + 1 < kStaleResponses) return Outcome::kPassed;
  return scene.raise({.arguments = {2}, .where = scene.bytes(0, node.wide ? 32 : 16), .variant = 2});
}

Outcome communication_errors_sustained(Scene& scene) {
  const Node& node = *scene.node;
  const auto limit = static_cast<std::uint32_t>(scene.limits().communication_errors);
  return node.communication_errors != 0 && node.communication_errors >= limit
             ? scene.raise({.arguments = {node.communication_errors}, .where = scene.bytes(1, 1)})
             : Outcome::kPassed;
}

Outcome too_many_axes(Scene& scene) {
  const Ring& ring = scene.ring;
  if (!ring.cycle_ns) return Outcome::kSilent;
  std::int64_t blocks = 0;
  for (unsigned i = 0; i < ring.node_count; ++i) blocks += (ring.wide_nodes >> i & 1U) != 0 ? 2 : 1;
  const std::int64_t allowed = ring.cycle_ns.value == 83'333 ? 5 : ring.cycle_ns.value == 166'667 ? 10 : 32;
  return blocks > allowed ? scene.raise({.arguments = {blocks, allowed}, .basis = ring.cycle_ns.basis})
                          : Outcome::kPassed;
}

Outcome mac_id_duplicate(Scene& scene) {
  std::array<std::int8_t, 32> place_of;
  place_of.fill(-1);
  for (const auto& node : scene.ring.all()) {
    if (node == nullptr || !node->command_written || node->command_frame != scene.now.frame) continue;
    std::int8_t& place = place_of[node->command.mac_id];
    if (place >= 0) return scene.raise({.arguments = {node->command.mac_id, place, node->place}});
    place = static_cast<std::int8_t>(node->place);
  }
  return Outcome::kPassed;
}

}  // namespace servotrace::rtex::checks
