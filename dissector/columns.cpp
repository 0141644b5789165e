// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/columns.hpp"

#include <array>
#include <cstring>
#include <string>

#include "dissector/dictionary.hpp"
#include "dissector/fields.hpp"
#include "dissector/text.hpp"

namespace servotrace::plugin {
namespace {

struct Columns {
  std::string key;  // empty: none were made
  Ends ends;
  std::string info;
};

// What the last frames said. Polls say the same again and again, and a sentence takes longer to make than to find.
class Memory {
 public:
  Columns& place(const std::string& key) { return kept_[hash_of(std::string_view(key)) >> kShift]; }
  void clear() { kept_ = {}; }

 private:
  static constexpr unsigned kBits = 8;
  static constexpr unsigned kShift = 64 - kBits;
  std::array<Columns, std::size_t{1} << kBits> kept_;
};

Memory& memory() {
  static Memory instance;
  return instance;
}

void append_number(std::string& key, std::uint64_t value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  key.append(bytes, sizeof bytes);
}

void append_text(std::string& key, std::string_view text) {
  append_number(key, text.size());
  key += text;
}

std::string_view as_text(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

// All that the columns of a DeviceNet frame are made of: times are not among it.
void make_key(const Visit& frame, std::string& key) {
  key.clear();
  append_number(key, frame.shape);
  append_text(key, as_text(frame.dissection->frame));
  append_text(key, as_text(frame.dissection->reassembled));
  for (const Derived& derived : frame.dissection->derived) {
    if (derived.field->kind == Kind::kText) {
      append_text(key, derived.text);
    } else if (derived.field->unit != Unit::kNanosecond) {
      append_number(key, static_cast<std::uint64_t>(derived.value));
    }
  }
}

void make_texts(const Dissection& dissection, Columns& columns) {
  columns.ends = ends_text(dissection);
  columns.info = info_text(dissection);
}

const Columns& columns_of(const Visit& frame) {
  // Each record of a ring is another: its counters move on.
  if (frame.dissection->protocol == Protocol::kDevicenet && frame.shape != FrameStore::kNoShape) {
    static std::string key;
    make_key(frame, key);
    Columns* const place = &memory().place(key);
    if (place->key == key) return *place;
    place->key.clear();
    make_texts(*frame.dissection, *place);
    place->key = key;
    return *place;
  }
  static Columns made;
  make_texts(*frame.dissection, made);
  return made;
}

void set_address(packet_info* pinfo, address& place, const std::string& text) {
  if (text.empty()) return;
  ::set_address(&place, AT_STRINGZ, static_cast<int>(text.size()) + 1, pool_text(pinfo->pool, text));
}

}  // namespace

void draw_columns(packet_info* pinfo, const Visit& frame) {
  const Dissection& dissection = *frame.dissection;
  column_info* const columns = pinfo->cinfo;
  if (dissection.protocol == Protocol::kNone || columns == nullptr || !col_get_writable(columns, COL_INFO)) return;
  std::string_view protocol = dissection.protocol == Protocol::kRtex ? "rtex" : "dnet";
  for (const Segment& segment : dissection.segments) {
    if (segment.layout->protocol != "rtex" && segment.layout->protocol != "dnet") protocol = segment.layout->protocol;
  }
  col_set_str(columns, COL_PROTOCOL, protocol_column(protocol));
  const Columns& texts = columns_of(frame);
  set_address(pinfo, pinfo->src, texts.ends.source);
  set_address(pinfo, pinfo->dst, texts.ends.destination);
  if (!texts.info.empty()) col_add_str(columns, COL_INFO, texts.info.c_str());
}

void reset_columns() { memory().clear(); }

}  // namespace servotrace::plugin
