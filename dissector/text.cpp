// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/text.hpp"

#include <string>

#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/sentence.hpp"
#include "decoder/render/value.hpp"
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
  std::string text = " (" + scaled_text(value, field.scale);
  if (!unit.empty()) {
    text += ' ';
    text += unit;
  }
  return pool_text(pool, text + ")");
}

const char* node_text(wmem_allocator_t* pool, const NodeRef& node) {
  if (node.mac_id == kNoMacId) {
    switch (node.bus.kind) {
      case BusKind::kRing:
        return wmem_strdup_printf(pool, "ring%u", unsigned{node.bus.number});
      case BusKind::kCan:
        return wmem_strdup_printf(pool, "can%u", node.bus.interface_id);
      case BusKind::kNone:
        break;
    }
    return "capture";
  }
  const Settings* const settings = session_settings();
  return pool_text(
      pool, servotrace::node_text(node, settings == nullptr ? std::string_view() : configured_name(*settings, node)));
}

const char* info_text(wmem_allocator_t* pool, const Dissection& dissection) {
  return pool_text(pool, sentence(dissection, session_settings()));
}

}  // namespace servotrace::plugin
