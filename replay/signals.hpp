// SPDX-License-Identifier: MIT
// The process values and states of a capture as series: one a bus, node and field. Visitors over the layouts: what a
// field is good for stands in its row (Role).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "decoder/core/slot.hpp"
#include "replay/run.hpp"

namespace servotrace::replay {

struct Series {
  std::string name;  // "ring0.axis3.command.command_position"
  const Field* field = nullptr;
  NodeRef node;
};

// The drives of an RTEX record that have answered. Until a drive does, its block is all zero with C/R = 0 (SX-DSV02203
// 4-3-2): no values and no states.
class Answered {
 public:
  // False where `segment` is a part of a block nobody has filled; segments come in the order of the dissection.
  bool operator()(const Dissection& dissection, const Segment& segment);

 private:
  bool answered_ = true;
};

// Finds the series of a dissection; a series keeps its number through the capture.
class SeriesList {
 public:
  // visit(series number, field, raw value) for every signal (and state, where `states`) of the frame. `states` is the
  // same in every call.
  template <class Visit>
  void for_each(const Dissection& dissection, bool states, Visit visit) {
    Answered answered;
    for (const Segment& segment : dissection.segments) {
      if (!answered(dissection, segment) || segment.node.mac_id == kNoMacId) continue;
      const Bytes bytes = dissection.bytes(segment);
      for (const Column& column : columns(segment, states)) {
        visit(column.number, *column.field, read(column.slot, bytes));
      }
    }
  }
  // Takes note of the series of the frame, without their values.
  void note(const Dissection& dissection, bool states);
  // Names them; after the last frame.
  std::vector<Series> named(const BusNames& buses) const;

 private:
  // Variants of a layout share their key: a series is its filter name, on one node.
  using Key = std::tuple<std::uint32_t, std::uint8_t, std::uint8_t, std::int16_t, std::string_view, std::string_view,
                         std::string_view>;
  struct Entry {
    NodeRef node;
    const Layout* layout = nullptr;
    const Field* field = nullptr;
  };
  // A field of a layout at a node, with the number of its series.
  struct Column {
    const Field* field = nullptr;
    Slot slot;
    std::size_t number = 0;
  };
  struct Place {
    const Layout* layout = nullptr;
    std::uint64_t node = 0;
    bool operator==(const Place&) const = default;
  };
  struct PlaceHash {
    std::size_t operator()(const Place& place) const {
      return std::hash<const void*>()(place.layout) ^ std::hash<std::uint64_t>()(place.node * 0x9E3779B97F4A7C15U);
    }
  };
  const std::vector<Column>& columns(const Segment& segment, bool states);
  std::size_t number(const Segment& segment, const Field& field);

  std::unordered_map<Place, std::vector<Column>, PlaceHash> columns_;
  std::map<Key, std::size_t> numbers_;
  std::vector<Entry> entries_;
};

// What a state's value is called: its name, else the number.
std::string state_text(const Field& field, std::int64_t raw);

}  // namespace servotrace::replay
