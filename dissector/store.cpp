// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/store.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace servotrace::plugin {
namespace {

constexpr std::size_t kChunkSize = std::size_t{1} << 20;  // bytes
constexpr std::size_t kLongestNumber = 10;                // bytes of 64 bits, seven in each

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && next_ < bytes_.size(); shift += 7) {
      const auto byte = static_cast<std::uint8_t>(bytes_[next_++]);
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if ((byte & 0x80U) == 0) break;
    }
    return value;
  }
  std::uint32_t number32() { return static_cast<std::uint32_t>(number()); }
  std::int64_t signed_number() {
    const std::uint64_t bits = number();
    return static_cast<std::int64_t>((bits & 1U) != 0 ? ~(bits >> 1U) : bits >> 1U);
  }
  Bytes take(std::size_t size) {
    const std::string_view result = bytes_.substr(next_, size <= bytes_.size() - next_ ? size : 0);
    next_ += result.size();
    return {reinterpret_cast<const std::uint8_t*>(result.data()), result.size()};
  }

 private:
  std::string_view bytes_;
  std::size_t next_ = 0;
};

// Rows that differ in no more than this are told apart by ==.
std::uint64_t node_bits(const NodeRef& node) {
  return static_cast<std::uint64_t>(static_cast<std::uint16_t>(node.mac_id)) | std::uint64_t{node.place} << 16U |
         static_cast<std::uint64_t>(node.channel) << 24U | std::uint64_t{node.bus.interface_id} << 32U;
}

std::uint64_t address_bits(const void* address) { return reinterpret_cast<std::uintptr_t>(address); }

// Does the frame a link names learn of all it is named by? Of the others only of the one behind it.
bool is_answer(LinkKind kind) { return kind != LinkKind::kPreviousOfNode; }

}  // namespace

std::uint64_t FrameStore::HeadRow::hash() const {
  return mix(bus.interface_id, static_cast<std::uint64_t>(protocol) | static_cast<std::uint64_t>(direction) << 8U |
                                   std::uint64_t{bus.number} << 16U);
}
std::uint64_t FrameStore::SegmentRow::hash() const {
  const std::uint64_t place = std::uint64_t{segment.offset} | std::uint64_t{segment.length} << 32U;
  return mix(mix(address_bits(segment.layout), place), node_bits(segment.node));
}
std::uint64_t FrameStore::DerivedRow::hash() const { return mix(address_bits(field), node_bits(node)); }
std::uint64_t FrameStore::LinkRow::hash() const { return mix(static_cast<std::uint64_t>(kind), node_bits(node)); }

bool FrameStore::SegmentRow::operator==(const SegmentRow& other) const {
  const Segment& a = segment;
  const Segment& b = other.segment;
  return a.layout == b.layout && a.offset == b.offset && a.length == b.length && a.buffer == b.buffer &&
         a.node == b.node && a.direction == b.direction && a.guessed == b.guessed;
}

void FrameStore::Writer::begin(std::size_t numbers, std::size_t bytes) {
  const std::size_t room = numbers * kLongestNumber + bytes;
  if (buffer_.size() < room) buffer_.resize(room);
  next_ = buffer_.data();
}

// Seven bits a byte, the highest bit says that more follow.
void FrameStore::Writer::number(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7U) *next_++ = static_cast<std::uint8_t>(value | 0x80U);
  *next_++ = static_cast<std::uint8_t>(value);
}

void FrameStore::Writer::signed_number(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  number(value < 0 ? ~(bits << 1U) : bits << 1U);
}

void FrameStore::Writer::append(Bytes bytes) { next_ = std::copy(bytes.begin(), bytes.end(), next_); }

std::string_view FrameStore::Writer::written() const {
  return {reinterpret_cast<const char*>(buffer_.data()), static_cast<std::size_t>(next_ - buffer_.data())};
}

std::string_view FrameStore::keep(std::string_view bytes) {
  if (chunk_size_ - chunk_used_ < bytes.size() || chunks_.empty()) {
    chunk_size_ = std::max(bytes.size(), kChunkSize);
    chunk_used_ = 0;
    chunks_.push_back(std::make_unique<std::uint8_t[]>(chunk_size_));
    chunk_bytes_ += chunk_size_;
  }
  std::uint8_t* const place = chunks_.back().get() + chunk_used_;
  if (!bytes.empty()) std::memcpy(place, bytes.data(), bytes.size());
  chunk_used_ += bytes.size();
  return {reinterpret_cast<const char*>(place), bytes.size()};
}

std::uint32_t FrameStore::kept(Dictionary<std::string_view>& dictionary, std::string_view text) {
  return dictionary.number(text, [this](std::string_view same) { return keep(same); });
}

// Leaves the rows of the links in link_rows_.
std::uint32_t FrameStore::shape_of(const Dissection& dissection) {
  shape_.begin(dissection.segments.size() + dissection.derived.size() + dissection.links.size() + 4, 0);
  shape_.number(heads_.number({dissection.protocol, dissection.direction, dissection.bus}));
  for (const Segment& segment : dissection.segments) shape_.number(std::uint64_t{segments_.number({segment})} + 1);
  shape_.number(0);
  for (const Derived& derived : dissection.derived)
    shape_.number(std::uint64_t{derived_.number({derived.field, derived.protocol, derived.node})} + 1);
  shape_.number(0);
  link_rows_.clear();
  for (const Link& link : dissection.links) {
    link_rows_.push_back(links_.number({link.kind, link.node}));
    shape_.number(std::uint64_t{link_rows_.back()} + 1);
  }
  shape_.number(0);
  return kept(shapes_, shape_.written());
}

std::uint32_t FrameStore::put(std::uint32_t number, const Dissection& dissection, Found found) {
  if (frames_.size() <= number) frames_.resize(std::size_t{number} + 1);
  frames_[number] = {};
  if (dissection.segments.empty() && dissection.derived.empty() && dissection.links.empty() &&
      dissection.protocol == Protocol::kNone && found.count == 0)
    return kNoShape;
  const std::uint32_t shape = shape_of(dissection);
  values_.begin(2 * (dissection.derived.size() + dissection.links.size()) + 4, dissection.reassembled.size());
  values_.number(shape);
  values_.number(found.count);
  if (found.count != 0) values_.number(found.first);
  values_.number(dissection.reassembled.size());
  values_.append(dissection.reassembled);
  for (const Derived& derived : dissection.derived) {
    values_.signed_number(derived.value);
    if (derived.field->kind == Kind::kText) values_.number(kept(texts_, derived.text));
  }
  for (std::size_t i = 0; i < dissection.links.size(); ++i) {
    const Link& link = dissection.links[i];
    values_.signed_number(static_cast<std::int64_t>(number) - static_cast<std::int64_t>(link.frame));
    values_.signed_number(link.after_ns);
    add_link(link, link_rows_[i], number);
  }
  const std::string_view kept_values = keep(values_.written());
  frames_[number].data = reinterpret_cast<const std::uint8_t*>(kept_values.data());
  frames_[number].size = static_cast<std::uint32_t>(kept_values.size());
  return shape;
}

void FrameStore::add_link(const Link& link, std::uint32_t row, std::uint32_t number) {
  if (link.frame == 0 || link.frame >= number) return;
  if (is_answer(link.kind)) {
    add_answer(link, row, number);
  } else {
    frames_[link.frame].next = number;
  }
}

void FrameStore::add_answer(const Link& link, std::uint32_t row, std::uint32_t number) {
  if (last_answers_.size() <= link.frame) last_answers_.resize(frames_.size());
  std::uint32_t& last = last_answers_[link.frame];
  const auto index = static_cast<std::uint32_t>(answer_rows_.size());
  std::uint32_t first = index;
  if (last != 0) first = std::exchange(answer_rows_[last - 1].next, index);
  answer_rows_.push_back({.next = first, .frame = number, .after_ns = link.after_ns, .link = row});
  last = index + 1;
}

std::uint32_t FrameStore::get(std::uint32_t number, Bytes frame, Dissection& dissection, Found& found) const {
  dissection.clear();
  dissection.frame = frame;
  found = {};
  if (number >= frames_.size() || frames_[number].data == nullptr) return kNoShape;
  Reader values({reinterpret_cast<const char*>(frames_[number].data), frames_[number].size});
  const std::uint32_t number_of_shape = values.number32();
  Reader shape(shapes_[number_of_shape]);
  found.count = values.number32();
  if (found.count != 0) found.first = values.number32();
  dissection.reassembled = values.take(values.number());
  const HeadRow& head = heads_[shape.number()];
  dissection.protocol = head.protocol;
  dissection.bus = head.bus;
  dissection.direction = head.direction;
  while (const std::uint64_t row = shape.number())
    dissection.add(segments_[row - 1].segment);  // looks again whether the bytes are there
  while (const std::uint64_t row = shape.number()) {
    const DerivedRow& common = derived_[row - 1];
    Derived derived{.field = common.field, .protocol = common.protocol, .node = common.node};
    derived.value = values.signed_number();
    if (derived.field->kind == Kind::kText) derived.text = texts_[values.number()];
    dissection.derived.push_back(derived);
  }
  while (const std::uint64_t row = shape.number()) {
    const LinkRow& common = links_[row - 1];
    Link link{.kind = common.kind, .node = common.node};
    link.frame = static_cast<std::uint64_t>(static_cast<std::int64_t>(number) - values.signed_number());
    link.after_ns = values.signed_number();
    dissection.links.push_back(link);
  }
  return number_of_shape;
}

void FrameStore::answers(std::uint32_t number, std::vector<Answer>& out) const {
  out.clear();
  if (number >= last_answers_.size() || last_answers_[number] == 0) return;
  const std::uint32_t last = last_answers_[number] - 1;
  std::uint32_t index = last;
  do {
    index = answer_rows_[index].next;
    const AnswerRow& row = answer_rows_[index];
    out.push_back({links_[row.link].kind, row.frame, row.after_ns, links_[row.link].node});
  } while (index != last);
}

std::size_t FrameStore::bytes_used() const {
  return chunk_bytes_ + frames_.capacity() * sizeof(FrameRow) + answer_rows_.capacity() * sizeof(AnswerRow) +
         last_answers_.capacity() * sizeof(std::uint32_t);
}

}  // namespace servotrace::plugin
