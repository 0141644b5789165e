// SPDX-License-Identifier: MIT
#include "replay/capture/text_source.hpp"

#include <algorithm>
#include <cstring>

#include "replay/capture/limits.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kMaxChannels = 1024;  // searched one by one

constexpr std::uint32_t kExtendedFlag = 0x80000000U;
constexpr std::uint32_t kRemoteFlag = 0x40000000U;
constexpr std::uint32_t kErrorFlag = 0x20000000U;
constexpr std::uint8_t kFdFlag = 0x04;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || is_blank(line.back()))) line.remove_suffix(1);
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  return line;
}

}  // namespace

Source::Step LineSource::read_line(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const Bytes there = input_->at_hand();
    const std::size_t reach = std::min(there.size(), kMaxLine);
    const void* const found = reach > searched ? std::memchr(there.data() + searched, '\n', reach - searched) : nullptr;
    if (input_->lost()) return fail_line(kLost);
    if (found != nullptr) {
      const auto length = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - there.data());
      line = std::string_view(reinterpret_cast<const char*>(there.data()), length);
      byte_offset_ = 0;
      input_->skip(length + 1);
      if (++line_number_ == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
      line = trimmed(line);
      return Step::kFrame;
    }
    if (there.size() >= kMaxLine) {
      ++line_number_;
      return fail_line("a line of more than " + std::to_string(kMaxLine) + " bytes");
    }
    searched = there.size();
    const Bytes more = input_->peek(there.size() + 1);
    if (more.size() > there.size()) continue;
    // A last line without its end may be cut: it is no whole record.
    const bool blank = std::all_of(more.begin(), more.end(), [](std::uint8_t byte) { return byte <= ' '; });
    if (!blank) {
      ++line_number_;
      unfinished_ = trimmed(std::string_view(reinterpret_cast<const char*>(more.data()), more.size()));
    }
    return end(blank ? 0 : more.size(), more.size() + 1);
  }
}

Source::Step LineSource::fail_line(std::string what) {
  error_ = Error{name_ + ":" + std::to_string(line_number_), std::move(what)};
  return Step::kError;
}

Source::Step TextSource::next(RawFrame& frame) {
  if (!error_.what.empty()) return Step::kError;
  for (;;) {
    std::string_view line;
    const Step step = read_line(line);
    if (step != Step::kFrame) return step;
    CanRecord record;
    switch (parse(line, record)) {
      case Line::kRecord:
        return emit(record, frame);
      case Line::kBroken:
        return fail_line(std::move(what_));
      case Line::kNothing:
        break;
    }
  }
}

Source::Step TextSource::emit(const CanRecord& record, RawFrame& frame) {
  const std::string_view channel = record.channel.substr(0, kMaxName);
  if (last_interface_ >= interfaces_.size() || interfaces_[last_interface_].name != channel) {
    const auto place = std::find_if(interfaces_.begin(), interfaces_.end(),
                                    [channel](const InterfaceInfo& info) { return info.name == channel; });
    if (place == interfaces_.end()) {
      if (interfaces_.size() == kMaxChannels) return fail_line("more than 1024 channels");
      interfaces_.push_back({.link_type = LinkType::kCanSocketcan,
                             .name = std::string(channel),
                             .time_resolution_ns = record.resolution_ns});
      last_interface_ = static_cast<std::uint32_t>(interfaces_.size() - 1);
    } else {
      last_interface_ = static_cast<std::uint32_t>(place - interfaces_.begin());
    }
  }
  std::uint32_t word = record.identifier;
  if (record.extended) word |= kExtendedFlag;
  if (record.remote) word |= kRemoteFlag;
  if (record.error) word |= kErrorFlag;
  for (unsigned i = 0; i < 4; ++i) bytes_[i] = static_cast<std::uint8_t>(word >> (24U - 8U * i));
  bytes_[4] = record.length;
  bytes_[5] = record.fd ? static_cast<std::uint8_t>(kFdFlag | record.fd_flags) : std::uint8_t{0};
  bytes_[6] = bytes_[7] = 0;
  const std::size_t length = record.remote ? 0 : record.length;
  std::copy_n(record.data.begin(), length, bytes_.begin() + 8);
  frame.number = ++number_;
  frame.time_ns = record.time_ns;
  frame.link_type = LinkType::kCanSocketcan;
  frame.interface_id = last_interface_;
  frame.bytes = Bytes(bytes_).first(8 + length);
  frame.original_length = static_cast<std::uint32_t>(8 + length);
  frame.file_order = ByteOrder::kBig;
  frame.time_resolution_ns = interfaces_[last_interface_].time_resolution_ns;
  frame.has_time = true;
  return Step::kFrame;
}

std::string_view Words::next() {
  while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  std::size_t length = 0;
  while (length < rest_.size() && !is_blank(rest_[length])) ++length;
  const std::string_view word = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return word;
}

std::optional<std::uint32_t> parse_hex(std::string_view text) {
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) text.remove_prefix(2);
  if (text.empty() || text.size() > 8) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : text) {
    unsigned digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<unsigned>(c - '0');
    } else if (c >= 'a' && c <= 'f') {
      digit = static_cast<unsigned>(c - 'a') + 10;
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<unsigned>(c - 'A') + 10;
    } else {
      return std::nullopt;
    }
    value = value << 4U | digit;
  }
  return value;
}

std::optional<std::uint64_t> parse_decimal(std::string_view text, std::uint64_t limit) {
  if (text.empty() || text.size() > 18) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + static_cast<unsigned>(c - '0');
  }
  if (value > limit) return std::nullopt;
  return value;
}

std::optional<TimeNs> parse_time(std::string_view text, std::int64_t unit_ns, unsigned* places) {
  __extension__ using Wide = __int128;
  bool negative = false;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    negative = text.front() == '-';
    text.remove_prefix(1);
  }
  const std::size_t point = text.find_first_of(".,");
  const std::string_view whole = text.substr(0, point);
  const std::string_view part = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  const auto seconds = parse_decimal(whole, 999'999'999'999'999'999);
  if (!seconds) return std::nullopt;
  Wide value = Wide{*seconds} * unit_ns;
  if (point != std::string_view::npos) {
    const auto fraction = parse_decimal(part, 999'999'999'999'999'999);
    if (!fraction) return std::nullopt;
    Wide divisor = 1;
    for (std::size_t i = 0; i < part.size(); ++i) divisor *= 10;
    value += Wide{*fraction} * unit_ns / divisor;
  }
  if (places != nullptr) *places = static_cast<unsigned>(part.size());
  if (value > INT64_MAX) return std::nullopt;
  return static_cast<TimeNs>(negative ? -value : value);
}

std::uint32_t resolution_of(std::int64_t unit_ns, unsigned places) {
  for (unsigned i = 0; i < places && unit_ns > 1; ++i) unit_ns /= 10;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(unit_ns, 1, 0xFFFF'FFFF));
}

TimeNs utc_ns(std::int64_t year, unsigned month, unsigned day, std::int64_t nanosecond_of_day) {
  // Days since 1970-01-01 in the Gregorian calendar, years beginning in March.
  if (month <= 2) --year;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (std::int64_t{month} + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const std::int64_t day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return (era * 146'097 + day_of_era - 719'468) * 86'400 * kSecondNs + nanosecond_of_day;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace servotrace::replay
