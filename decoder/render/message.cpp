// SPDX-License-Identifier: MIT
#include "decoder/render/message.hpp"

#include <fmt/format.h>

#include "decoder/findings/catalogue.hpp"

namespace servotrace {

std::string argument_text(const Argument& argument, std::int64_t value) {
  const ValueName* name = find_value(argument.names, value);
  const auto unsigned32 = static_cast<std::uint32_t>(value);
  const auto with_name = [name, value](std::string number) {
    if (name != nullptr && value < 0) return std::string(name->name);  // no number of the traffic: said in words
    return name == nullptr ? number : fmt::format("{} ({})", number, name->name);
  };
  switch (argument.format) {
    case ArgumentFormat::kDecimal:
      return fmt::format("{}", value);
    case ArgumentFormat::kHex2:
      return fmt::format("{:02X}h", unsigned32);
    case ArgumentFormat::kHex4:
      return fmt::format("{:04X}h", unsigned32);
    case ArgumentFormat::kHex8:
      return fmt::format("{:08X}h", unsigned32);
    case ArgumentFormat::kName:
      return name == nullptr ? fmt::format("{}", value) : std::string(name->name);
    case ArgumentFormat::kHex2Name:
      return with_name(fmt::format("{:02X}h", unsigned32));
    case ArgumentFormat::kHex4Name:
      return with_name(fmt::format("{:04X}h", unsigned32));
    case ArgumentFormat::kHex8Name:
      return with_name(fmt::format("{:08X}h", unsigned32));
    case ArgumentFormat::kDecimalName:
      return with_name(fmt::format("{}", value));
    case ArgumentFormat::kParameter:
      return fmt::format("Pr{}.{:02}", unsigned32 >> 8U & 0xFFU, unsigned32 & 0xFFU);
    case ArgumentFormat::kMainSub:
      return with_name(fmt::format("{}.{}", unsigned32 >> 8U & 0xFFU, unsigned32 & 0xFFU));
    case ArgumentFormat::kExactly:
      return value < 0 ? std::string()
                       : ", exactly " + argument_text({ArgumentFormat::kMainSub, argument.names}, value);
    case ArgumentFormat::kMilliseconds:
      return fmt::format("{:.3f}", static_cast<double>(value) / 1e6);
    case ArgumentFormat::kMicroseconds:
      return fmt::format("{:.1f}", static_cast<double>(value) / 1e3);
    case ArgumentFormat::kFlags:
    case ArgumentFormat::kBits: {
      std::string list;
      for (unsigned bit = 0; bit < 64; ++bit) {
        if ((static_cast<std::uint64_t>(value) >> bit & 1U) == 0) continue;
        if (!list.empty()) list += ", ";
        const ValueName* flag = argument.format == ArgumentFormat::kFlags ? find_value(argument.names, bit) : nullptr;
        list += flag == nullptr ? fmt::format("{}", bit) : std::string(flag->name);
      }
      return list.empty() ? "none" : list;
    }
  }
  return {};
}

std::string message(const Finding& finding) {
  const Rule& row = rule_row(finding.rule);
  std::string text;
  for (std::string_view rest = row.message; !rest.empty();) {
    const MessagePart part = first_part(rest);
    if (part.is_argument) {
      const std::int64_t value = finding.arguments[part.argument];
      text += argument_text(row.arguments[part.argument], value);
      if (!part.text.empty()) text += fmt::format(" {}{}", part.text, value == 1 ? "" : "s");
    } else {
      text += part.text;
    }
    rest.remove_prefix(part.length);
  }
  return text;
}

}  // namespace servotrace
