// SPDX-License-Identifier: MIT
// Vector ASC logs, as CANoe, CANalyzer, python-can and asc2log's relatives write them. Lines that are no CAN frame
// (status, statistics, other buses) are passed over.
#include <algorithm>

#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::string_view kMonths[] = {"jan", "feb", "mar", "apr", "may", "jun",
                                        "jul", "aug", "sep", "oct", "nov", "dec"};
// German tools write these months otherwise.
constexpr struct {
  std::string_view name;
  unsigned month;
} kOtherMonths[] = {{"m\xC3\xA4r", 3}, {"m\xE4r", 3}, {"mrz", 3}, {"mai", 5}, {"okt", 10}, {"dez", 12}};

unsigned month_of(std::string_view word) {
  const std::string name = lower(word);
  for (unsigned i = 0; i < 12; ++i) {
    if (name.substr(0, 3) == kMonths[i]) return i + 1;
  }
  for (const auto& other : kOtherMonths) {
    if (name.substr(0, other.name.size()) == other.name) return other.month;
  }
  return 0;
}

// "Tue Nov 14 10:13:22.501 PM 2023", with or without milliseconds and AM or PM.
std::optional<TimeNs> parse_date(std::string_view text) {
  Words words(text);
  words.next();  // the day of the week
  const unsigned month = month_of(words.next());
  const auto day = parse_decimal(words.next(), 31);
  const std::string_view clock = words.next();
  std::string_view year_word = words.next();
  std::string half = lower(year_word);
  if (half == "am" || half == "pm") {
    year_word = words.next();
  } else {
    half.clear();
  }
  const auto year = parse_decimal(year_word, 2200);
  if (month == 0 || !day || *day == 0 || !year || *year < 1970 || clock.size() < 8) return std::nullopt;
  if (clock[2] != ':' || clock[5] != ':') return std::nullopt;
  auto hour = parse_decimal(clock.substr(0, 2), 23);
  const auto minute = parse_decimal(clock.substr(3, 2), 59);
  const auto second = parse_time(clock.substr(6), kSecondNs);
  if (!hour || !minute || !second) return std::nullopt;
  if (half == "pm" && *hour < 12) *hour += 12;
  if (half == "am" && *hour == 12) *hour = 0;
  const auto minutes = static_cast<std::int64_t>(*hour * 60 + *minute);
  return utc_ns(static_cast<std::int64_t>(*year), month, static_cast<unsigned>(*day),
                minutes * 60 * kSecondNs + *second);
}

class AscSource final : public TextSource {
 public:
  AscSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : TextSource(std::move(input), std::move(name), std::move(format)) {}

 private:
  Line broken(const char* what) {
    what_ = std::string("no CAN frame of an ASC log: ") + what;
    return Line::kBroken;
  }

  Line parse(std::string_view line, CanRecord& record) override {
    if (line.empty() || line.substr(0, 2) == "//") return Line::kNothing;
    if (line.front() < '0' || line.front() > '9') return head(line);
    Words words(line);
    unsigned places = 0;
    const auto time = parse_time(words.next(), kSecondNs, &places);
    if (!time) return Line::kNothing;
    if (!relative_) offset_ns_ = 0;
    if (__builtin_add_overflow(offset_ns_, *time, &offset_ns_) ||
        __builtin_add_overflow(start_ns_, offset_ns_, &record.time_ns))
      return broken("its time is beyond the year 2262");
    record.resolution_ns = resolution_of(kSecondNs, places);
    const std::string_view first = words.next();
    if (lower(first) == "canfd") return fd_frame(words, record);
    const auto channel = parse_decimal(first, 255);
    if (!channel) return Line::kNothing;  // another bus, or an event of the whole measurement
    set_channel(*channel, record);
    return frame(words, record);
  }

  // The lines that are no event. What is not known of them changes nothing.
  Line head(std::string_view line) {
    Words words(line);
    const std::string word = lower(words.next());
    if (word == "date") {
      if (const auto date = parse_date(words.rest())) start_ns_ = *date;
    } else if (word == "base") {
      hexadecimal_ = lower(words.next()) != "dec";
      words.next();  // "timestamps"
      relative_ = lower(words.next()) == "relative";
    } else if (word == "begin" && !in_block_) {
      in_block_ = true;  // the first one: later blocks count on from the same start
      words.next();      // "Triggerblock"
      if (const auto date = parse_date(words.rest())) start_ns_ = *date;
    }
    return Line::kNothing;
  }

  void set_channel(std::uint64_t channel, CanRecord& record) {
    if (channel != channel_) channel_name_ = "CAN " + std::to_string(channel);
    channel_ = channel;
    record.channel = channel_name_;
  }

  std::optional<std::uint32_t> number(std::string_view word, std::uint32_t limit) const {
    std::optional<std::uint32_t> value;
    if (hexadecimal_) {
      value = parse_hex(word);
    } else if (const auto decimal = parse_decimal(word, limit)) {
      value = static_cast<std::uint32_t>(*decimal);
    }
    if (value && *value > limit) value.reset();
    return value;
  }

  // "5FF" or, of 29 bits, "18FF1234x".
  bool identifier(std::string_view word, CanRecord& record) const {
    record.extended = !word.empty() && (word.back() == 'x' || word.back() == 'X');
    if (record.extended) word.remove_suffix(1);
    const auto value = number(word, record.extended ? 0x1FFFFFFFU : 0x7FFU);
    if (!value) return false;
    record.identifier = *value;
    return true;
  }

  // Logs with symbolic names give the number behind the data: "ID = 100x", always decimal.
  static bool identifier_behind(std::string_view rest, CanRecord& record) {
    const std::size_t place = rest.find("ID = ");
    if (place == std::string_view::npos) return false;
    std::string_view word = Words(rest.substr(place + 5)).next();
    record.extended = !word.empty() && word.back() == 'x';
    if (record.extended) word.remove_suffix(1);
    const auto value = parse_decimal(word, record.extended ? 0x1FFFFFFFU : 0x7FFU);
    if (!value) return false;
    record.identifier = static_cast<std::uint32_t>(*value);
    return true;
  }

  bool data(Words& words, std::size_t count, CanRecord& record) const {
    for (std::size_t i = 0; i < count; ++i) {
      const auto byte = number(words.next(), 0xFF);
      if (!byte) return false;
      record.data[i] = static_cast<std::uint8_t>(*byte);
    }
    return true;
  }

  // Behind time and channel: "5FF Rx d 7 00 34 ...", "5FF Rx r", "ErrorFrame".
  Line frame(Words words, CanRecord& record) {
    const std::string_view id = words.next();
    if (lower(id.substr(0, 10)) == "errorframe") {
      record.error = true;
      record.length = 8;
      return Line::kRecord;
    }
    const std::string direction = lower(words.next());
    if (direction != "rx" && direction != "tx") return Line::kNothing;  // status, statistics, a request to send
    const std::string kind = lower(words.next());
    if (kind != "d" && kind != "r") return Line::kNothing;
    const bool numeric = identifier(id, record);
    record.remote = kind == "r";
    const std::string_view length_word = words.next();
    const auto length = number(length_word, 0xF);
    if (!record.remote) {
      if (!length) return broken("its data length is no number");
      record.length = static_cast<std::uint8_t>(std::min(*length, 8U));  // 9 to 15 mean 8 bytes too
      if (!data(words, record.length, record)) return broken("fewer data bytes than its length says");
    } else if (length) {
      record.length = static_cast<std::uint8_t>(std::min(*length, 8U));
    }
    if (!numeric && !identifier_behind(words.rest(), record))
      return broken("its identifier is a name; record with numeric identifiers");
    return Line::kRecord;
  }

  // Behind time and "CANFD": "1 Rx 11 [name] 1 0 d 12 00 ...": bit rate switch, error state, length code, bytes, data.
  Line fd_frame(Words words, CanRecord& record) {
    const auto channel = parse_decimal(words.next(), 255);
    const std::string direction = lower(words.next());
    if (!channel || (direction != "rx" && direction != "tx")) return Line::kNothing;
    set_channel(*channel, record);
    const std::string_view id = words.next();
    if (lower(id.substr(0, 10)) == "errorframe") {
      record.error = true;
      record.length = 8;
      return Line::kRecord;
    }
    if (!identifier(id, record)) return broken("its identifier is no number");
    std::string_view rate_switch = words.next();
    if (rate_switch != "0" && rate_switch != "1") rate_switch = words.next();  // over a symbolic name
    const std::string_view state = words.next();
    words.next();  // the length code
    const auto length = parse_decimal(words.next(), 64);
    if (!length) return broken("its data length is no number");
    record.length = static_cast<std::uint8_t>(*length);
    if (!data(words, record.length, record)) return broken("fewer data bytes than its length says");
    // Behind the data: duration, bits, flags. Bit 12 of the flags marks a CAN FD frame; without them it is one.
    words.next();
    words.next();
    const auto flags = parse_hex(words.next());
    record.fd = !flags || (*flags & 0x1000U) != 0;
    if (record.fd) record.fd_flags = static_cast<std::uint8_t>((rate_switch == "1" ? 1 : 0) | (state == "1" ? 2 : 0));
    if (!record.fd && record.length > 8) record.fd = true;
    return Line::kRecord;
  }

  TimeNs start_ns_ = 0;
  TimeNs offset_ns_ = 0;
  std::uint64_t channel_ = 256;  // of channel_name_; none yet
  std::string channel_name_;
  bool hexadecimal_ = true;
  bool relative_ = false;
  bool in_block_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> read_asc(std::unique_ptr<Input> input, std::string name, std::string format) {
  return std::unique_ptr<Source>(std::make_unique<AscSource>(std::move(input), std::move(name), std::move(format)));
}

}  // namespace servotrace::replay
