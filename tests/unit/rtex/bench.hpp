// SPDX-License-Identifier: MIT
// A small ring: the test writes the commands, the bench sends them as records and answers as healthy drives do, with
// Update_Counter_Echo one cycle and Command_Code_Echo two cycles behind (SX-DSV02203 3-1).
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "decoder/link/rtex_record.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace::rtex::test {

struct Place {
  bool wide = false;
  std::array<std::uint8_t, 32> command = {};
  std::array<std::array<std::uint8_t, 32>, 4> sent = {};  // the last commands, newest first
  std::uint8_t actual_mac = 0;
  bool ready = true, alarm = false, warning = false, homing_complete = false, in_progress = false;
  bool busy = false;  // of every non-cyclic answer
  bool wng = false, err = false;
  std::uint16_t error_code = 0;  // not 0: CMD_Error
  std::uint16_t sub_error_code = 0;
  std::int32_t position = 0, speed = 0;
  bool follow = true;                      // the position follows Command_Data1 in CP
  std::uint32_t data = 0;                  // Monitor_Data of non-cyclic answers
  bool a4n_ignores = true;                 // arguments count as they were when the code changed
  std::array<std::uint8_t, 8> taken = {};  // arguments the drive took
  std::uint8_t last_code = 0;
  std::array<std::uint8_t, 32> response = {};
};

class Bench {
 public:
  explicit Bench(std::size_t nodes = 1, Settings settings = {}, DurationNs cycle_ns = 500'000)
      : pipeline_(settings), cycle_ns_(cycle_ns), places_(nodes) {
    for (std::size_t i = 0; i < nodes; ++i) {
      places_[i].actual_mac = static_cast<std::uint8_t>(i);
      set(i, "mac_id", static_cast<std::int64_t>(i));
      set(i, "cyclic_command", 2);
    }
  }

  Place& at(std::size_t i) { return places_[i]; }
  MutableBytes command(std::size_t i = 0) { return places_[i].command; }
  void set(std::size_t i, std::string_view key, std::int64_t value) {
    const Field* field = kCommand.find(key);
    ok_ = write(slot_of(*field), MutableBytes(places_[i].command), value) && ok_;
  }
  // Code, Type_Code, Index, Setting_Data of the main channel.
  void non_cyclic(std::size_t i, std::uint8_t code, std::uint16_t type, std::uint16_t index = 0,
                  std::int32_t data3 = 0) {
    set(i, "non_cyclic_command", code);
    auto words = MutableBytes(places_[i].command).subspan(8);
    ok_ = write(slot(kReset, "type_code"), words, type) && write(slot(kReset, "index"), words, index) && ok_;
    ok_ = write(slot(kSettingData, "setting_data"), words.subspan(4), data3) && ok_;
  }
  void normal(std::size_t i = 0) { non_cyclic(i, 0, 0); }
  void sub(std::size_t i, std::uint8_t code, std::uint8_t type, std::uint16_t index = 0) {
    auto words = MutableBytes(places_[i].command).subspan(16);
    ok_ = write(slot(kSubCommand, "sub_chk"), words, 1) && write(slot(kSubCommand, "command"), words, code) &&
          write(slot(kSubCommand, "type_code"), words, type) && write(slot(kSubCommand, "index"), words, index) && ok_;
  }
  // A MAC-ID other than the place: a NOP block of MAC-ID 0 is all zero and so not written yet.
  void mac(std::size_t i, std::uint8_t mac_id) {
    places_[i].actual_mac = mac_id;
    set(i, "mac_id", mac_id);
  }
  void position(std::size_t i, std::int32_t value) {
    ok_ = write(slot(kCommandPosition, "command_position"), MutableBytes(places_[i].command).subspan(4), value) && ok_;
  }

  unsigned ratio = 1;
  bool count = true;  // Update_Counter counts by itself
  bool send_response = true;
  bool sequence_valid = true, cycle_valid = true, sampled = false;
  std::uint32_t sequence = 0;
  DurationNs extra_ns = 0;                                         // added once before the next command
  std::function<void(std::size_t, MutableBytes)> on_response;      // changes a response block before it is recorded
  std::function<void(std::uint64_t, const Dissection&)> on_frame;  // what the frame became

  void cycles(unsigned number) {
    for (unsigned n = 0; n < number; ++n) cycle();
  }
  void cycle() {
    time_ += cycle_ns_ + extra_ns;
    extra_ns = 0;
    if (count && tick_++ % ratio == 0) {
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (read(slot(kCommand, "cyclic_command"), places_[i].command) != 0)
          set(i, "update_counter", (read(slot(kCommand, "update_counter"), places_[i].command) + 1) & 3);
      }
    }
    for (Place& place : places_) {
      std::rotate(place.sent.begin(), place.sent.end() - 1, place.sent.end());
      place.sent[0] = place.command;
    }
    record(false);
    answer();
    if (send_response) record(true);
    ++sequence;
  }
  void drop_cycles(std::uint32_t number) {
    sequence += number;
    time_ += number * cycle_ns_;
  }

  Pipeline& pipeline() { return pipeline_; }
  bool ok() const { return ok_; }
  std::uint64_t frame() const { return frame_; }
  TimeNs time() const { return time_; }
  // Findings of a rule ("RX201"); with a place, those of it alone.
  std::vector<Finding> found(std::string_view id, int mac_id = -2) const {
    std::vector<Finding> list;
    for (const Finding& finding : pipeline_.findings().all()) {
      if (rule_row(finding.rule).id == id && (mac_id == -2 || finding.node.mac_id == mac_id)) list.push_back(finding);
    }
    return list;
  }
  // Every finding as "RX201", sorted and unique: what a test expects as a whole.
  std::string rules() const {
    std::vector<std::string> ids;
    for (const Finding& finding : pipeline_.findings().all()) ids.emplace_back(rule_row(finding.rule).id);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::string text;
    for (const std::string& id : ids) text += (text.empty() ? "" : " ") + id;
    return text;
  }

 private:
  void answer() {
    for (Place& place : places_) {
      const auto& before = place.sent[2];  // the command two cycles before: code echo lag
      auto& block = place.response;
      block = {};
      const auto put = [&](const Layout& layout, std::string_view key, std::size_t offset, std::int64_t value) {
        ok_ = write(slot_of(*layout.find(key)), MutableBytes(block).subspan(offset), value) && ok_;
      };
      const auto code = read(slot(kCommand, "non_cyclic_command"), before);
      const auto cyclic = read(slot(kCommand, "cyclic_command"), before);
      if (place.follow && read(slot(kCommand, "cyclic_command"), place.sent[0]) == 2)
        place.position = static_cast<std::int32_t>(
            read(slot(kCommandPosition, "command_position"), Bytes(place.sent[0]).subspan(4)));
      put(kResponse, "mac_id", 0, place.actual_mac);
      put(kResponse, "cr", 0, 1);
      put(kResponse, "update_counter_echo", 0, read(slot(kCommand, "update_counter"), place.sent[1]));
      put(kResponse, "non_cyclic_command_echo", 0, code);
      put(kResponse, "cyclic_command_echo", 0, cyclic);
      put(kResponse, "servo_ready", 0, place.ready);
      put(kResponse, "servo_active", 0, read(slot(kCommand, "servo_on"), before));
      put(kResponse, "alarm", 0, place.alarm);
      put(kResponse, "warning", 0, place.warning);
      put(kResponse, "homing_complete", 0, place.homing_complete);
      put(kResponse, "in_progress", 0, place.in_progress);
      put(kPositionEcho, "setting_data_echo", 4, place.position);
      if (place.error_code != 0) {
        put(kResponse, "cmd_error", 0, 1);
        put(kError, "error_code", 8, place.error_code);
      } else if (code == 0) {
        place.last_code = 0;
        put(kPositionEcho, "setting_data_echo", 8, place.speed);
      } else {
        // The arguments are taken when the code changes; in extend mode at any time.
        if (code != place.last_code || !place.a4n_ignores) std::copy_n(before.begin() + 8, 8, place.taken.begin());
        place.last_code = static_cast<std::uint8_t>(code);
        std::copy_n(place.taken.begin(), 4, block.begin() + 8);
        put(kMonitorEcho, "busy", 8, place.busy);
        put(kMonitorEcho, "wng", 8, place.wng);
        put(kMonitorEcho, "err", 8, place.err);
        put(kRawMonitor[0], "monitor_data", 12, place.data);
      }
      if (place.wide) {
        put(kSubResponse, "command_echo", 16, read(slot(kSubCommand, "command"), Bytes(before).subspan(16)));
        if (place.sub_error_code != 0) {
          put(kSubError, "cmd_err", 16, 1);
          put(kSubError, "error_code", 16, place.sub_error_code);
        } else {
          put(kSubResponse, "type_code_echo", 16, read(slot(kSubCommand, "type_code"), Bytes(before).subspan(16)));
          put(kSubResponse, "index_echo", 16, read(slot(kSubCommand, "index"), Bytes(before).subspan(16)));
        }
      }
    }
  }

  void record(bool response) {
    std::vector<std::uint8_t> bytes(kRecord.size, 0);
    const auto put = [&](std::string_view key, std::int64_t value) {
      ok_ = write(slot_of(*kRecord.find(key)), bytes, value) && ok_;
    };
    bytes[0] = 'R', bytes[1] = 'T', bytes[2] = 'E', bytes[3] = 'X';
    put("version", 1);
    put("header_length", 24);
    put("direction", response);
    put("sequence_valid", sequence_valid);
    put("cycle_valid", cycle_valid);
    put("sampled", sampled);
    put("sequence", sequence);
    put("cycle_ns", cycle_valid ? cycle_ns_ : 0);
    std::uint32_t wide = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) wide |= places_[i].wide ? 1U << i : 0U;
    put("wide_nodes", wide);
    put("node_count", static_cast<std::int64_t>(places_.size()));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      auto block = response ? places_[i].response : places_[i].command;
      if (response && on_response) on_response(i, block);
      bytes.insert(bytes.end(), block.begin(), block.begin() + (places_[i].wide ? 32 : 16));
    }
    const RawFrame frame{.number = ++frame_,
                         .time_ns = time_ + (response ? cycle_ns_ / 5 : 0),
                         .link_type = LinkType::kUser0,
                         .bytes = bytes,
                         .original_length = static_cast<std::uint32_t>(bytes.size())};
    pipeline_.push(frame, on_frame ? &dissection_ : nullptr);
    if (on_frame) on_frame(frame_, dissection_);
  }

  Pipeline pipeline_;
  Dissection dissection_;
  DurationNs cycle_ns_;
  std::vector<Place> places_;
  TimeNs time_ = seconds(1'700'000'000);
  std::uint64_t frame_ = 0;
  unsigned tick_ = 0;
  bool ok_ = true;
};

}  // namespace servotrace::rtex::test
