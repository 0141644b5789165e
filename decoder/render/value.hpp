// SPDX-License-Identifier: MIT
// The text of values: scaled, named, with their unit. For people and for JSON; never on the checking path.
#pragma once

#include <string>
#include <string_view>

#include "decoder/core/layout.hpp"
#include "decoder/core/slot.hpp"
#include "decoder/core/time.hpp"
#include "decoder/findings/finding.hpp"

namespace servotrace {

// raw * ratio as a decimal number, exact where nine places suffice, without trailing zeros: "12", "-0.1".
std::string scaled_text(std::int64_t raw, Ratio scale);
// The same with `places` behind the point at least: "45.0".
std::string scaled_text(std::int64_t raw, Ratio scale, unsigned places);
// The decimal places a manual gives such a value: 3 for 1/1000; 0 where the scale is no decimal point.
unsigned decimal_places(Ratio scale);

// The number without name or unit, with the manual's decimal places: "12", "45.0", "-0.1", "1Fh" (as many digits as the
// field is wide).
std::string number_text(const Field& field, std::int64_t raw);

// The value as people read it: "31h (Z phase)", "12.5 r/min", "CP cyclic position (2)".
std::string value_text(const Field& field, std::int64_t raw);

// The characters of a text row: `bytes` without the NULs that fill them up.
std::string_view characters(Bytes bytes);

// value_text for bytes and text rows: "0A 1B", "\"NS310\"" (unprintable bytes as \xNN).
std::string bytes_text(const Field& field, Bytes bytes);

// Why is_violation() holds: "must be 0", "is none of the listed values", "must be 1 to 10"; empty where it does not.
std::string violation_text(const Field& field, std::int64_t raw);

// "rtex.command.update_counter".
std::string filter_name(const Layout& layout, const Field& field);

// "2026-11-24T10:15:30.123456789Z".
std::string time_text(TimeNs time_ns);
// Seconds since the epoch with nine places: "1764000000.000000000".
std::string seconds_text(TimeNs time_ns);
// "0.5 ms", "12.3 us", "2.5 s": three significant places at least.
std::string duration_text(DurationNs duration_ns);

// "main", "sub", "poll" ...; empty for kNone.
std::string_view name_of(Channel channel);
std::string_view name_of(Protocol protocol);  // "rtex", "devicenet"; empty for kNone

// Every field of a layout with its bytes: visit(field, raw value, its bytes). Raw is 0 for bytes and text rows.
// Precondition: fits(layout, bytes).
template <class Visit>
void for_each_field(const Layout& layout, Bytes bytes, Visit visit) {
  for (const Field& field : layout.fields) {
    const Slot place = slot_of(field);
    visit(field, place.width == 0 ? 0 : read(place, bytes), bytes_of(field, bytes));
  }
}

}  // namespace servotrace
