// SPDX-License-Identifier: MIT
// A drive session on its own: feeds whole messages to it and keeps what it finds. Without the link layer.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/findings/catalogue.hpp"
#include "decoder/findings/repeat.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/render/message.hpp"

namespace servotrace::test {

class DriveBench {
 public:
  explicit DriveBench(const DriveProfile& profile, Settings settings = {}, bool decode_only = false)
      : settings_(std::move(settings)), findings_(settings_.max_findings) {
    const NodeRef node{.bus = {BusKind::kCan, 0, 0}, .protocol = Protocol::kDevicenet, .mac_id = 5};
    session_ = profile.make_session(settings_, node, findings_.owner(node), decode_only);
  }

  // Every message advances the time by `step_ms` first.
  std::int64_t step_ms = 5;

  void command(const std::vector<std::uint8_t>& bytes) {
    begin(bytes);
    session_->on_command(context(), message(bytes));
  }
  void response(const std::vector<std::uint8_t>& bytes) {
    begin(bytes);
    session_->on_response(context(), message(bytes));
  }
  void poll(const std::vector<std::uint8_t>& out, const std::vector<std::uint8_t>& in, int times = 1) {
    for (int i = 0; i < times; ++i) {
      command(out);
      response(in);
    }
  }
  // An explicit request and its answer. Set and Reset answer without data.
  void request(std::uint8_t service, std::uint16_t class_id, std::uint16_t instance, std::int32_t attribute,
               const std::vector<std::uint8_t>& data = {}) {
    begin(data);
    exchange_ = {};
    exchange_.service = service;
    exchange_.class_id = class_id;
    exchange_.instance = instance;
    exchange_.attribute = attribute;
    request_data_ = data;
    exchange_.request_data = request_data_;
    exchange_.request_frame = frame_.number;
    exchange_.request_time_ns = frame_.time_ns;
    exchange_.request = message(request_data_);
    session_->on_explicit(context(), exchange_);
  }
  void answer(const std::vector<std::uint8_t>& data = {}, std::uint8_t general_status = 0) {
    begin(data);
    exchange_.request = {};
    exchange_.is_response = true;
    exchange_.is_error = general_status != 0;
    exchange_.general_status = general_status;
    exchange_.response = message(data);
    session_->on_explicit(context(), exchange_);
  }
  void set(std::uint16_t class_id, std::uint16_t instance, std::int32_t attribute,
           const std::vector<std::uint8_t>& data, std::uint8_t general_status = 0) {
    request(0x10, class_id, instance, attribute, data);
    answer({}, general_status);
  }
  void get(std::uint16_t class_id, std::uint16_t instance, std::int32_t attribute,
           const std::vector<std::uint8_t>& data) {
    request(0x0E, class_id, instance, attribute);
    answer(data);
  }
  void start() {
    begin({});
    session_->on_start(context());
  }
  void gap() { session_->on_gap(); }
  void other_frame() {
    begin({});
    session_->on_time(context());
  }
  void wait_ms(std::int64_t duration) { frame_.time_ns += milliseconds(duration); }
  void finish() { session_->on_finish(context()); }

  std::uint64_t frame() const { return frame_.number; }
  DriveSession& session() { return *session_; }
  const Findings& findings() const { return findings_; }
  const Dissection& dissection() const { return dissection_; }
  int count(std::string_view id) const {
    int found = 0;
    for (const Finding& finding : findings_.all()) found += rule_row(finding.rule).id == id ? 1 : 0;
    return found;
  }
  // The last finding of a rule. Precondition: there is one.
  const Finding& last(std::string_view id) const {
    const Finding* found = nullptr;
    for (const Finding& finding : findings_.all()) {
      if (rule_row(finding.rule).id == id) found = &finding;
    }
    EXPECT_NE(found, nullptr) << id;
    static const Finding kNone;
    return found == nullptr ? kNone : *found;
  }
  // Every rule found, "YS101 YS102", in the order of the ids.
  std::string rules() const {
    std::set<std::string> ids;
    for (const Finding& finding : findings_.all()) ids.emplace(rule_row(finding.rule).id);
    std::string all;
    for (const std::string& id : ids) all += (all.empty() ? "" : " ") + id;
    return all;
  }

 private:
  void begin(const std::vector<std::uint8_t>& bytes) {
    bytes_ = bytes;
    ++frame_.number;
    frame_.time_ns += milliseconds(step_ms);
    frame_.link_type = LinkType::kCanSocketcan;
    frame_.bytes = bytes_;
    dissection_.clear();
    dissection_.frame = bytes_;
  }
  Context context() { return {frame_, settings_, findings_, &dissection_}; }
  Message message(const std::vector<std::uint8_t>&) const {
    return {.bytes = bytes_,
            .buffer = Buffer::kFrame,
            .offset = 0,
            .first_frame = frame_.number,
            .in_frame = {0, static_cast<std::uint32_t>(bytes_.size())}};
  }

  Settings settings_;
  Findings findings_;
  std::unique_ptr<DriveSession> session_;
  RawFrame frame_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint8_t> request_data_;
  Dissection dissection_;
  ExplicitExchange exchange_;
};

}  // namespace servotrace::test
