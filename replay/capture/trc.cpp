// SPDX-License-Identifier: MIT
// PEAK TRC logs, file versions 1.0 to 1.3 (fixed columns) and 2.0 and 2.1 (columns named by $COLUMNS).
#include <algorithm>

#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::int64_t kDaysTo1970 = 25'569;  // from 1899-12-30, where $STARTTIME counts from
constexpr std::int64_t kDayNs = 86'400 * kSecondNs;

// N number, O offset in ms, T type, B bus, I identifier, d direction, R reserved, l length code, L length, D data.
// In versions 1.1 to 1.3 the place of the direction also tells warnings and errors.
struct Version {
  std::string_view name;
  std::string_view columns;
};
constexpr Version kVersions[] = {{"1.0", "NOIlD"},    {"1.1", "NOdIlD"},  {"1.2", "NOBdIlD"},
                                 {"1.3", "NOBdIRlD"}, {"2.0", "NOTIdlD"}, {"2.1", "NOTBIdRlD"}};

class TrcSource final : public TextSource {
 public:
  TrcSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : TextSource(std::move(input), std::move(name), std::move(format)) {}

 private:
  Line broken(const char* what) {
    what_ = std::string("no line of a TRC log: ") + what;
    return Line::kBroken;
  }

  Line parse(std::string_view line, CanRecord& record) override {
    if (line.empty()) return Line::kNothing;
    if (line.front() == ';') return head(line.substr(1));
    Words words(line);
    skip_ = false;
    for (const char column : columns_) {
      if (column == 'D') break;  // the rest of the line
      const std::string_view word = words.next();
      if (word.empty() && (skip_ || record.error)) break;
      if (word.empty()) return broken("fewer columns than the header says");
      if (!take(column, word, record)) return Line::kBroken;
    }
    if (skip_) return Line::kNothing;
    return data(words, record);
  }

  Line head(std::string_view line) {
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    const std::size_t mark = line.find('=');
    if (line.empty() || line.front() != '$' || mark == std::string_view::npos) return Line::kNothing;
    const std::string key = lower(line.substr(1, mark - 1));
    const std::string_view value = line.substr(mark + 1);
    if (key == "fileversion") {
      const auto* const version = std::find_if(std::begin(kVersions), std::end(kVersions),
                                               [value](const Version& known) { return known.name == value; });
      if (version == std::end(kVersions)) return broken("its file version is not known");
      columns_ = version->columns;
    } else if (key == "starttime") {
      const std::string_view number = value.substr(0, value.find(';'));
      if (const auto days = parse_time(number, kDayNs)) start_ns_ = *days - kDaysTo1970 * kDayNs;
    } else if (key == "columns") {
      columns_.clear();
      for (const char c : value) {
        if (c != ',' && c != ' ') columns_ += c;
      }
      if (columns_.find('I') == std::string::npos || columns_.find('D') == std::string::npos)
        return broken("its columns have no identifier or no data");
    }
    return Line::kNothing;
  }

  bool refuse(const char* what) {
    broken(what);
    return false;
  }

  bool take(char column, std::string_view word, CanRecord& record) {
    switch (column) {
      case 'O': {
        unsigned places = 0;
        const auto time = parse_time(word, kMillisecondNs, &places);
        if (!time) return refuse("its time is no number");
        if (__builtin_add_overflow(start_ns_, *time, &record.time_ns))
          return refuse("its time is beyond the year 2262");
        record.resolution_ns = resolution_of(kMillisecondNs, places);
        return true;
      }
      case 'T':
        return type(word, record);
      case 'd': {                       // versions 1.1 to 1.3 put the kind of event here
        if (record.error) return true;  // its columns may be blank, and this a later one
        const std::string direction = lower(word);
        if (direction == "error") {
          record.error = true;
        } else if (direction != "rx" && direction != "tx") {
          skip_ = true;  // a warning of the adapter
        }
        return true;
      }
      case 'B':
        if (word != bus_) {
          bus_ = word;
          bus_name_ = "CAN " + bus_;
        }
        record.channel = bus_name_;
        return true;
      case 'I': {
        if (word == "-" || skip_ || record.error) return true;  // events have none
        const auto identifier = parse_hex(word);
        if (!identifier) return refuse("its identifier is no number");
        if (*identifier == 0xFFFFFFFFU) skip_ = true;  // a warning of the adapter, in version 1.0
        if (skip_) return true;
        if (*identifier > 0x1FFFFFFFU) return refuse("an identifier above 1FFFFFFF");
        record.extended = word.size() > 4;
        record.identifier = *identifier;
        if (!record.extended && *identifier > 0x7FF) return refuse("an identifier of 4 digits above 7FF");
        return true;
      }
      case 'l':
      case 'L': {
        const auto length = parse_decimal(word, 64);
        if (!length && !skip_ && !record.error) return refuse("its data length is no number");
        record.length = static_cast<std::uint8_t>(length.value_or(0));
        if (column == 'l' && record.fd) record.length = fd_length(record.length);
        return true;
      }
      default:
        return true;  // number, reserved
    }
  }

  static std::uint8_t fd_length(std::uint8_t code) {
    constexpr std::uint8_t kLengths[] = {12, 16, 20, 24, 32, 48, 64};
    return code >= 9 && code <= 15 ? kLengths[code - 9] : code;
  }

  bool type(std::string_view word, CanRecord& record) {
    if (word == "DT") return true;
    if (word == "RR") {
      record.remote = true;
    } else if (word == "FD" || word == "FB" || word == "FE" || word == "BI") {
      record.fd = true;
      record.fd_flags = static_cast<std::uint8_t>(word == "FB" ? 1 : word == "FE" ? 2 : word == "BI" ? 3 : 0);
    } else if (word == "ER") {
      record.error = true;
    } else {
      skip_ = true;  // hardware status, error counters, events
    }
    return true;
  }

  Line data(Words& words, CanRecord& record) {
    std::string_view word = words.next();
    if (word == "ERROR") record.error = true;  // version 1.0
    if (record.error) {
      // What the adapter says about the error is its own; the frame only tells that there was one.
      record.extended = false;
      record.identifier = 0;
      record.length = 8;
      record.data = {};
      return Line::kRecord;
    }
    if (word == "RTR") record.remote = true;
    if (!record.fd && record.length > 8) record.length = 8;  // length codes 9 to 15 mean 8 bytes
    if (record.remote) return Line::kRecord;
    std::size_t count = 0;
    for (; !word.empty() && count < record.length; word = words.next()) {
      const auto byte = word.size() <= 2 ? parse_hex(word) : std::nullopt;
      if (!byte) return broken("data that are no hexadecimal bytes");
      record.data[count++] = static_cast<std::uint8_t>(*byte);
    }
    if (count < record.length) return broken("fewer data bytes than its length says");
    return Line::kRecord;
  }

  std::string columns_ = "NOIlD";  // version 1.0 does not name itself
  TimeNs start_ns_ = 0;
  std::string bus_;
  std::string bus_name_;
  bool skip_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> read_trc(std::unique_ptr<Input> input, std::string name, std::string format) {
  return std::unique_ptr<Source>(std::make_unique<TrcSource>(std::move(input), std::move(name), std::move(format)));
}

}  // namespace servotrace::replay
