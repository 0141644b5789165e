// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/text.hpp"

#include <string>

#include "decoder/render/message.hpp"
#include "dissector/session.hpp"

namespace servotrace::plugin {

const char* pool_text(wmem_allocator_t* pool, std::string_view text) {
  return wmem_strndup(pool, text.data(), text.size());
}

const char* message_text(wmem_allocator_t* pool, const Finding& finding) { return pool_text(pool, message(finding)); }

const char* unit_text(wmem_allocator_t* pool, const Field& field, std::int64_t value) {
  const std::string_view unit = symbol(field.unit);
  if (field.scale == Ratio{}) {
    if (unit.empty()) return "";
    return wmem_strdup_printf(pool, " %s", pool_text(pool, unit));
  }
  int places = 0;
  std::int64_t power = 1;
  while (power < field.scale.denominator) {
    power *= 10;
    ++places;
  }
  if (power != field.scale.denominator && places < 3) places = 3;
  const double scaled = static_cast<double>(value) * field.scale.numerator / field.scale.denominator;
  if (unit.empty()) return wmem_strdup_printf(pool, " (%.*f)", places, scaled);
  return wmem_strdup_printf(pool, " (%.*f %s)", places, scaled, pool_text(pool, unit));
}

const char* info_text(wmem_allocator_t* pool, const Dissection& dissection) {
  std::string text;
  const Layout* last = nullptr;
  for (const Segment& segment : dissection.segments) {
    if (segment.layout == last) continue;
    last = segment.layout;
    if (!text.empty()) text += ", ";
    text += segment.layout->title;
  }
  return pool_text(pool, text);
}

}  // namespace servotrace::plugin
