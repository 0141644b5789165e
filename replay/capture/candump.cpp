// SPDX-License-Identifier: MIT
// Logs of candump -l (can-utils): "(1700000002.501431) can0 5FF#00341245230000".
#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000U;

class CandumpSource final : public TextSource {
 public:
  CandumpSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : TextSource(std::move(input), std::move(name), std::move(format)) {}

 private:
  Line broken(const char* what) {
    what_ = std::string("no line of a candump log: ") + what;
    return Line::kBroken;
  }

  Line parse(std::string_view line, CanRecord& record) override {
    if (line.empty() || line.front() == '#') return Line::kNothing;
    Words words(line);
    const std::string_view stamp = words.next();
    if (stamp.size() < 3 || stamp.front() != '(' || stamp.back() != ')') return broken("it begins with no (time)");
    unsigned places = 0;
    const auto time = parse_time(stamp.substr(1, stamp.size() - 2), kSecondNs, &places);
    if (!time) return broken("its time is no number");
    record.time_ns = *time;
    record.resolution_ns = resolution_of(kSecondNs, places);
    record.channel = words.next();
    const std::string_view frame = words.next();
    const std::size_t mark = frame.find('#');
    if (mark == std::string_view::npos) return broken("no identifier#data behind the interface");
    const std::string_view digits = frame.substr(0, mark);
    const auto identifier = parse_hex(digits);
    if (!identifier || (digits.size() != 3 && digits.size() != 8))
      return broken("an identifier that has neither 3 nor 8 hexadecimal digits");
    record.extended = digits.size() == 8;
    record.error = record.extended && (*identifier & kErrorFlag) != 0;
    if (record.error) record.extended = false;
    record.identifier = *identifier & (digits.size() == 8 ? 0x1FFFFFFFU : 0x7FFU);
    return parse_data(frame.substr(mark + 1), record);
  }

  Line parse_data(std::string_view data, CanRecord& record) {
    std::size_t limit = 8;
    if (!data.empty() && data.front() == '#') {
      const auto flags = data.size() > 1 ? parse_hex(data.substr(1, 1)) : std::nullopt;
      if (!flags) return broken("a CAN FD frame without its flags");
      record.fd = true;
      record.fd_flags = static_cast<std::uint8_t>(*flags & 0x3U);
      data.remove_prefix(2);
      limit = 64;
    }
    const std::size_t raw_length = data.find('_');  // the length code above 8 of a classic frame
    if (raw_length != std::string_view::npos) data = data.substr(0, raw_length);
    if (!record.fd && !data.empty() && (data.front() == 'R' || data.front() == 'r')) {
      record.remote = true;
      const auto length = data.size() > 1 ? parse_hex(data.substr(1)) : std::optional<std::uint32_t>(0);
      if (!length || *length > 8) return broken("a remote frame of an impossible length");
      record.length = static_cast<std::uint8_t>(*length);
      return Line::kRecord;
    }
    std::size_t count = 0;
    while (!data.empty()) {
      if (data.front() == '.') {  // candump can put points between the bytes
        data.remove_prefix(1);
        continue;
      }
      const auto byte = data.size() >= 2 ? parse_hex(data.substr(0, 2)) : std::nullopt;
      if (!byte) return broken("data that are no pairs of hexadecimal digits");
      if (count == limit) return broken("more data than a frame can hold");
      record.data[count++] = static_cast<std::uint8_t>(*byte);
      data.remove_prefix(2);
    }
    record.length = static_cast<std::uint8_t>(count);
    return Line::kRecord;
  }
};

}  // namespace

Result<std::unique_ptr<Source>> read_candump(std::unique_ptr<Input> input, std::string name, std::string format) {
  return std::unique_ptr<Source>(std::make_unique<CandumpSource>(std::move(input), std::move(name), std::move(format)));
}

}  // namespace servotrace::replay
