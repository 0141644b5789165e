// SPDX-License-Identifier: MIT
// What a frame became: which layout lies at which bytes, and what the sessions know about it. No values are copied and
// no text is made: renderers walk layout and bytes. Valid until the next Pipeline::push.
#pragma once

#include <cstdint>

#include "decoder/core/layout.hpp"
#include "decoder/core/slot.hpp"
#include "decoder/core/small_vector.hpp"
#include "decoder/findings/finding.hpp"

namespace servotrace {

enum class Direction : std::uint8_t { kNone, kCommand, kResponse };  // master to drive, drive to master

enum class Buffer : std::uint8_t { kFrame, kReassembled };

// A layout laid over bytes [offset, offset + length) of the frame or of the reassembled message. length >=
// layout->size.
struct Segment {
  const Layout* layout = nullptr;
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
  Buffer buffer = Buffer::kFrame;
  NodeRef node;  // mac_id kNoMacId: of the whole bus or record
  Direction direction = Direction::kNone;
  bool guessed = false;  // the drive profile or the meaning is a guess
};

// A value that no single frame holds: response time, learnt cycle, echo latency. `field` gives key, label, unit and
// kind (kUnsigned, kSigned, kBool, kText); its filter name is `<protocol>.<key>`, its bit position means nothing.
struct Derived {
  const Field* field = nullptr;
  std::string_view protocol;
  std::int64_t value = 0;
  std::string_view text;  // kText: bytes owned by a session, valid as long as the dissection
  NodeRef node;
};

enum class LinkKind : std::uint8_t {
  kRequestIn,       // this frame answers the one at `frame`
  kAcceptedIn,      // non-cyclic command accepted (echoed)
  kPreviousOfNode,  // the previous frame of the same node, direction and kind of message
  kFirstFragment,
  kReassembledFrom,  // an earlier fragment of the message completed here
};

struct Link {
  LinkKind kind = LinkKind::kRequestIn;
  std::uint64_t frame = 0;
  DurationNs after_ns = 0;  // from that frame to this one
  NodeRef node;
};

struct Dissection {
  // 32 blocks of a record at up to 6 layouts each, and the headers around them.
  SmallVector<Segment, 224> segments;
  SmallVector<Derived, 96> derived;
  SmallVector<Link, 96> links;
  Protocol protocol = Protocol::kNone;
  BusRef bus;
  Direction direction = Direction::kNone;
  Bytes frame;        // the frame's bytes, as pushed
  Bytes reassembled;  // the message this frame completes; owned by a session, valid until the next push
  // Asked for by whoever hands the dissection over, kept by clear(): a record that says nothing new need not be taken
  // apart. One that was not `repeats`: but for the Update_Counters its blocks are those of the record of that ring and
  // direction before, and it has no segments of them.
  bool only_news = false;
  bool repeats = false;

  void clear() {
    segments.clear();
    derived.clear();
    links.clear();
    protocol = Protocol::kNone;
    bus = {};
    direction = Direction::kNone;
    frame = {};
    reassembled = {};
    repeats = false;
  }
  // The bytes under a segment.
  Bytes bytes(const Segment& segment) const {
    const Bytes all = segment.buffer == Buffer::kFrame ? frame : reassembled;
    if (segment.offset > all.size() || segment.length > all.size() - segment.offset) return {};
    return all.subspan(segment.offset, segment.length);
  }
  // Lays `layout` over the bytes where they suffice; false (and nothing added) where they do not.
  bool add(const Segment& segment) {
    const Bytes under = bytes(segment);
    if (segment.layout == nullptr || under.size() != segment.length || under.size() < segment.layout->size)
      return false;
    return segments.push_back(segment);
  }
};

}  // namespace servotrace
