// SPDX-License-Identifier: MIT
// What all text logs of CAN frames have in common: lines, channels, and the SocketCAN frame made of each.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "replay/capture/readers.hpp"

namespace servotrace::replay {

// A CAN frame as a log tells it.
struct CanRecord {
  TimeNs time_ns = 0;
  std::uint32_t identifier = 0;  // 11 or 29 bits
  bool extended = false;
  bool remote = false;
  bool error = false;
  bool fd = false;
  std::uint8_t fd_flags = 0;               // bit rate switch 1, error state 2
  std::uint8_t length = 0;                 // bytes of data; of a remote frame: bytes asked for
  std::array<std::uint8_t, 64> data = {};  // 8 at most unless fd
  std::string_view channel;                // names the interface
  std::uint32_t resolution_ns = 1;         // of the log's timestamps
};

// A log read line by line.
class LineSource : public FileSource {
 protected:
  using FileSource::FileSource;

  // The next line without its end. kEnd: there is none.
  Step read_line(std::string_view& line);
  Step fail_line(std::string what);
  // After kEnd: a last line without its end, which may be cut; empty where there is none.
  std::string_view unfinished() const { return unfinished_; }

 private:
  std::uint64_t line_number_ = 0;
  std::string_view unfinished_;
};

class TextSource : public LineSource {
 public:
  Step next(RawFrame& frame) final;

 protected:
  using LineSource::LineSource;

  enum class Line : std::uint8_t { kRecord, kNothing, kBroken };
  // kRecord: `record` is filled. kBroken: `what_` says what is wrong.
  virtual Line parse(std::string_view line, CanRecord& record) = 0;

  std::string what_;

 private:
  Step emit(const CanRecord& record, RawFrame& frame);

  std::uint64_t number_ = 0;
  std::uint32_t last_interface_ = 0;
  std::array<std::uint8_t, 8 + 64> bytes_ = {};
};

// Words of a line, separated by blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  // Empty at the end of the line.
  std::string_view next();
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// 1 to 8 hexadecimal digits and nothing else; an "0x" in front is passed over.
std::optional<std::uint32_t> parse_hex(std::string_view text);
// Decimal digits and nothing else, up to `limit`.
std::optional<std::uint64_t> parse_decimal(std::string_view text, std::uint64_t limit);
// "12.345" times `unit_ns`, exactly; at most 18 places. `places` receives how many there are.
std::optional<TimeNs> parse_time(std::string_view text, std::int64_t unit_ns, unsigned* places = nullptr);
// The time between two steps of a number with that many places.
std::uint32_t resolution_of(std::int64_t unit_ns, unsigned places);
// Nanoseconds since 1970 of a UTC date; months and days from 1.
TimeNs utc_ns(std::int64_t year, unsigned month, unsigned day, std::int64_t nanosecond_of_day);
// `text` with A-Z made a-z.
std::string lower(std::string_view text);

}  // namespace servotrace::replay
