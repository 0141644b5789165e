// SPDX-License-Identifier: MIT
// A dissection in full, field by field, as JSON. What is written of a field depends on its row and its value alone, and
// most values come again: their texts are kept.
#pragma once

#include <cstdint>
#include <string_view>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"
#include "decoder/render/json.hpp"
#include "decoder/render/text_cache.hpp"

namespace servotrace {

class DissectionJson {
 public:
  // `settings` names the nodes and must outlive this.
  explicit DissectionJson(const Settings& settings) : settings_(settings) {}

  // Writes the members "segments", "derived" and "links" into the open object of a writer of one line.
  void write(JsonWriter& json, const Dissection& dissection);

 private:
  struct FieldKey {
    const Field* field = nullptr;
    std::int64_t raw = 0;
    bool operator==(const FieldKey&) const = default;
    std::uint64_t hash() const;
  };
  // What stands in front of the fields of a segment.
  struct HeadKey {
    const Layout* layout = nullptr;
    NodeRef node;
    std::uint32_t offset = 0;
    std::uint32_t length = 0;
    Buffer buffer = Buffer::kFrame;
    bool guessed = false;
    bool operator==(const HeadKey&) const = default;
    std::uint64_t hash() const;
  };
  struct DerivedKey {
    const Field* field = nullptr;
    std::string_view protocol;
    std::int64_t value = 0;
    NodeRef node;
    bool operator==(const DerivedKey&) const = default;
    std::uint64_t hash() const;
  };

  void write_segment(JsonWriter& json, const Segment& segment, Bytes bytes);
  void write_derived(JsonWriter& json, const Derived& entry);

  const Settings& settings_;
  TextCache<FieldKey> fields_{12};
  TextCache<HeadKey> heads_{9};
  TextCache<DerivedKey> derived_{9};
};

}  // namespace servotrace
