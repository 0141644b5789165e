// SPDX-License-Identifier: MIT
#include "decoder/render/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace servotrace {
namespace {

constexpr unsigned kMostDecimalPlaces = 4;  // of a manual; finer scales are conversions

bool is_number(const Field& field) { return slot_of(field).width != 0; }

// Days since 1970-01-01 to the civil date (proleptic Gregorian).
struct Civil {
  std::int64_t year;
  unsigned month;
  unsigned day;
};
Civil civil_of(std::int64_t days) {
  days += 719468;
  const std::int64_t era = (days >= 0 ? days : days - 146096) / 146097;
  const auto of_era = static_cast<unsigned>(days - era * 146097);
  const unsigned year_of_era = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  const unsigned of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const unsigned shifted = (5 * of_year + 2) / 153;
  const unsigned day = of_year - (153 * shifted + 2) / 5 + 1;
  const unsigned month = shifted < 10 ? shifted + 3 : shifted - 9;
  return {static_cast<std::int64_t>(year_of_era) + era * 400 + (month <= 2 ? 1 : 0), month, day};
}

// Whole seconds, rounded down, and the nanoseconds above them.
struct Split {
  std::int64_t seconds;
  std::int64_t nanoseconds;
};
Split split(TimeNs time_ns) {
  std::int64_t whole = time_ns / kSecondNs;
  std::int64_t rest = time_ns % kSecondNs;
  if (rest < 0) {
    rest += kSecondNs;
    --whole;
  }
  return {whole, rest};
}

// With nine digits: nanoseconds behind a point.
void append_nanoseconds(std::string& text, std::int64_t nanoseconds) {
  constexpr std::size_t kDigits = 9;
  const fmt::format_int digits(nanoseconds);
  text.append(kDigits - std::min(kDigits, digits.size()), '0').append(digits.data(), digits.size());
}

}  // namespace

std::string scaled_text(std::int64_t raw, Ratio scale) {
  if (scale.denominator == 1 && scale.numerator == 1) return fmt::format_int(raw).str();
  __extension__ typedef __int128 Wide;  // 64 bits times 32
  const Wide product = static_cast<Wide>(raw) * scale.numerator;
  const bool negative = product < 0;
  const Wide size = negative ? -product : product;
  const Wide denominator = scale.denominator;
  auto whole = static_cast<std::uint64_t>(size / denominator);
  // Nine places, the last one rounded.
  auto places = static_cast<std::uint64_t>(((size % denominator) * kSecondNs * 2 + denominator) / (denominator * 2));
  if (places >= static_cast<std::uint64_t>(kSecondNs)) {
    places = 0;
    ++whole;
  }
  std::string text = fmt::format("{}{}", negative && (whole != 0 || places != 0) ? "-" : "", whole);
  if (places == 0) return text;
  std::string digits = fmt::format("{:09}", places);
  digits.erase(digits.find_last_not_of('0') + 1);
  return text + "." + digits;
}

std::string scaled_text(std::int64_t raw, Ratio scale, unsigned places) {
  std::string text = scaled_text(raw, scale);
  const std::size_t point = text.find('.');
  const std::size_t shown = point == std::string::npos ? 0 : text.size() - point - 1;
  if (shown >= places) return text;
  if (shown == 0) text += '.';
  return text.append(places - shown, '0');
}

unsigned decimal_places(Ratio scale) {
  unsigned places = 0;
  std::int32_t rest = scale.denominator;
  while (rest % 10 == 0) {
    rest /= 10;
    ++places;
  }
  return scale.numerator == 1 && rest == 1 && places <= kMostDecimalPlaces ? places : 0;
}

std::string number_text(const Field& field, std::int64_t raw) {
  if (field.base == Base::kHex) {
    const std::uint64_t mask =
        field.width >= 64 || field.width == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.width) - 1;
    const int digits = field.width == 0 ? 2 : (field.width + 3) / 4;
    return fmt::format("{:0{}X}h", static_cast<std::uint64_t>(raw) & mask, digits);
  }
  if (field.kind == Kind::kUnsigned && raw < 0) return fmt::format_int(static_cast<std::uint64_t>(raw)).str();
  if (field.scale == Ratio{}) return fmt::format_int(raw).str();
  return scaled_text(raw, field.scale, decimal_places(field.scale));
}

std::string value_text(const Field& field, std::int64_t raw) {
  std::string text = number_text(field, raw);
  if (const ValueName* const name = find_value(field.values, raw)) {
    text.append(" (").append(name->name).append(")");
  } else if (const std::string_view unit = symbol(field.unit); !unit.empty()) {
    text.append(" ").append(unit);
  }
  return text;
}

std::string_view characters(Bytes bytes) {
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string bytes_text(const Field& field, Bytes bytes) {
  std::string text;
  if (field.kind != Kind::kText) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    for (const std::uint8_t byte : bytes) {
      if (!text.empty()) text += ' ';
      text += kDigits[byte >> 4U];
      text += kDigits[byte & 0xFU];
    }
    return text.empty() ? "none" : text;
  }
  text = "\"";
  for (const char c : characters(bytes)) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (c >= 0x20 && c < 0x7F) {
      text += c;
    } else {
      fmt::format_to(std::back_inserter(text), "\\x{:02X}", static_cast<std::uint8_t>(c));
    }
  }
  return text + "\"";
}

std::string violation_text(const Field& field, std::int64_t raw) {
  if (!is_number(field) || !is_violation(field, raw)) return {};
  if (field.reserved) return "must be 0";
  if (field.closed && find_value(field.values, raw) == nullptr) return "is none of the listed values";
  return fmt::format("must be {} to {}", number_text(field, field.range.minimum),
                     number_text(field, field.range.maximum));
}

std::string filter_name(const Layout& layout, const Field& field) {
  if (layout.key.empty()) return fmt::format("{}.{}", layout.protocol, field.key);
  return fmt::format("{}.{}.{}", layout.protocol, layout.key, field.key);
}

std::string time_text(TimeNs time_ns) {
  const auto [seconds_since_epoch, nanoseconds] = split(time_ns);
  std::int64_t days = seconds_since_epoch / 86400;
  std::int64_t of_day = seconds_since_epoch % 86400;
  if (of_day < 0) {
    of_day += 86400;
    --days;
  }
  const Civil date = civil_of(days);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}Z", date.year, date.month, date.day, of_day / 3600,
                     of_day / 60 % 60, of_day % 60, nanoseconds);
}

std::string seconds_text(TimeNs time_ns) {
  auto [whole, nanoseconds] = split(time_ns);
  std::string text;
  // -0.5 s is -1 s and half a second: written as the sign and the distance from zero.
  if (whole < 0 && nanoseconds != 0) {
    text = "-";
    whole = -(whole + 1);
    nanoseconds = kSecondNs - nanoseconds;
  }
  const fmt::format_int digits(whole);
  text.append(digits.data(), digits.size()).append(1, '.');
  append_nanoseconds(text, nanoseconds);
  return text;
}

std::string duration_text(DurationNs duration_ns) {
  const std::uint64_t size = duration_ns < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(duration_ns)
                                             : static_cast<std::uint64_t>(duration_ns);
  struct Step {
    std::uint64_t unit_ns;
    std::string_view unit;
  };
  constexpr Step kSteps[] = {{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "us"}};
  for (const auto& [unit_ns, unit] : kSteps) {
    if (size < unit_ns) continue;
    const std::uint64_t thousandths = (size % unit_ns) * 1000 / unit_ns;
    std::string text = fmt::format("{}{}", duration_ns < 0 ? "-" : "", size / unit_ns);
    if (thousandths != 0) {
      std::string digits = fmt::format("{:03}", thousandths);
      digits.erase(digits.find_last_not_of('0') + 1);
      text += "." + digits;
    }
    return fmt::format("{} {}", text, unit);
  }
  return fmt::format("{} ns", duration_ns);
}

std::string_view name_of(Channel channel) {
  switch (channel) {
    case Channel::kNone:
      return "";
    case Channel::kMain:
      return "main";
    case Channel::kSub:
      return "sub";
    case Channel::kPoll:
      return "poll";
    case Channel::kExplicit:
      return "explicit";
    case Channel::kUnconnected:
      return "unconnected";
  }
  return "";
}

std::string_view name_of(Protocol protocol) {
  switch (protocol) {
    case Protocol::kNone:
      return "";
    case Protocol::kRtex:
      return "rtex";
    case Protocol::kDevicenet:
      return "devicenet";
  }
  return "";
}

}  // namespace servotrace
