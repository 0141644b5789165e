// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/store.hpp"

#include <cstring>

namespace servotrace::plugin {
namespace {

constexpr std::size_t kChunkSize = std::size_t{1} << 20;  // bytes

// Numbers of any size in as few bytes as they need: seven bits a byte, the highest bit says that more follow.
void put_number(std::vector<std::uint8_t>& out, std::uint64_t value) {
  while (value >= 0x80) {
    out.push_back(static_cast<std::uint8_t>(value | 0x80U));
    value >>= 7U;
  }
  out.push_back(static_cast<std::uint8_t>(value));
}

void put_signed(std::vector<std::uint8_t>& out, std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  put_number(out, value < 0 ? ~(bits << 1U) : bits << 1U);
}

class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}
  std::uint64_t number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && next_ < bytes_.size(); shift += 7) {
      const std::uint8_t byte = bytes_[next_++];
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
    const Bytes result = bytes_.subspan(next_, size <= bytes_.size() - next_ ? size : 0);
    next_ += result.size();
    return result;
  }

 private:
  Bytes bytes_;
  std::size_t next_ = 0;
};

std::string_view as_text(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
Bytes as_bytes(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

std::uint32_t intern(std::unordered_map<std::string, std::uint32_t>& ids, std::vector<std::string_view>& keys,
                     std::string_view key) {
  const auto [entry, is_new] = ids.try_emplace(std::string(key), static_cast<std::uint32_t>(keys.size()));
  if (is_new) keys.push_back(entry->first);
  return entry->second;
}

// Does the frame a link names learn of all it is named by? Of the others only of the one behind it.
bool is_answer(LinkKind kind) { return kind != LinkKind::kPreviousOfNode; }

}  // namespace

FrameStore::FrameStore() : layouts_(all_layouts()), derived_(all_derived()) {
  for (std::uint32_t i = 0; i < layouts_.size(); ++i) layout_ids_.emplace(layouts_[i], i);
  for (std::uint32_t i = 0; i < derived_.size(); ++i)
    derived_ids_.emplace(std::pair(derived_[i].field, derived_[i].protocol), i);
}

FrameStore::Blob FrameStore::keep(Bytes bytes) {
  if (chunk_size_ - chunk_used_ < bytes.size() || chunks_.empty()) {
    chunk_size_ = bytes.size() > kChunkSize ? bytes.size() : kChunkSize;
    chunk_used_ = 0;
    chunks_.push_back(std::make_unique<std::uint8_t[]>(chunk_size_));
    chunk_bytes_ += chunk_size_;
  }
  std::uint8_t* const place = chunks_.back().get() + chunk_used_;
  if (!bytes.empty()) std::memcpy(place, bytes.data(), bytes.size());
  chunk_used_ += bytes.size();
  return {place, static_cast<std::uint32_t>(bytes.size())};
}

std::uint32_t FrameStore::node_id(const NodeRef& node) {
  // The pipeline follows no more than 1024 interfaces, so 16 bits hold their numbers.
  const std::uint64_t key = static_cast<std::uint64_t>(node.bus.kind) | std::uint64_t{node.bus.number} << 2U |
                            std::uint64_t{node.bus.interface_id & 0xFFFFU} << 10U |
                            static_cast<std::uint64_t>(node.protocol) << 26U | std::uint64_t{node.place} << 28U |
                            static_cast<std::uint64_t>(node.channel) << 36U |
                            std::uint64_t{static_cast<std::uint16_t>(node.mac_id)} << 40U;
  const auto [entry, is_new] = node_ids_.try_emplace(key, static_cast<std::uint32_t>(nodes_.size()));
  if (is_new) nodes_.push_back(node);
  return entry->second;
}

std::uint32_t FrameStore::text_id(std::string_view text) { return intern(text_ids_, texts_, text); }

void FrameStore::add_answer(const Link& link, std::uint32_t number) {
  if (link.frame == 0 || link.frame >= number) return;
  const auto target = static_cast<std::uint32_t>(link.frame);
  answer_rows_.push_back(
      {.next = 0, .frame = number, .after_ns = link.after_ns, .node = node_id(link.node), .kind = link.kind});
  const auto index = static_cast<std::uint32_t>(answer_rows_.size());
  AnswerEnds& ends = answer_ends_[target];
  if (ends.last != 0) answer_rows_[ends.last - 1].next = index;
  if (ends.first == 0) ends.first = index;
  ends.last = index;
}

void FrameStore::put(std::uint32_t number, const Dissection& dissection, Found found) {
  if (frames_.size() <= number) frames_.resize(std::size_t{number} + 1);
  frames_[number] = {};
  if (dissection.segments.empty() && dissection.derived.empty() && dissection.links.empty() &&
      dissection.protocol == Protocol::kNone && found.count == 0)
    return;
  shape_.clear();
  values_.clear();
  put_number(shape_, static_cast<std::uint64_t>(dissection.protocol));
  put_number(shape_, node_id(NodeRef{.bus = dissection.bus}));
  put_number(shape_, static_cast<std::uint64_t>(dissection.direction));
  const auto id_of = [this](const auto& ids, const auto& key) {
    const auto entry = ids.find(key);
    if (entry != ids.end()) return std::int64_t{entry->second};
    ++unregistered_;
    return std::int64_t{-1};
  };
  for (const Segment& segment : dissection.segments) {
    const std::int64_t layout = id_of(layout_ids_, segment.layout);
    if (layout < 0) continue;
    put_number(shape_, static_cast<std::uint64_t>(layout) + 1);
    put_number(shape_, segment.offset);
    put_number(shape_, segment.length);
    put_number(shape_, static_cast<std::uint64_t>(segment.buffer) |
                           static_cast<std::uint64_t>(segment.direction) << 1U |
                           static_cast<std::uint64_t>(segment.guessed) << 3U);
    put_number(shape_, node_id(segment.node));
  }
  put_number(shape_, 0);
  put_number(values_, found.count);
  if (found.count != 0) put_number(values_, found.first);
  put_number(values_, dissection.reassembled.size());
  values_.insert(values_.end(), dissection.reassembled.begin(), dissection.reassembled.end());
  for (const Derived& derived : dissection.derived) {
    const std::int64_t field = id_of(derived_ids_, std::pair(derived.field, derived.protocol));
    if (field < 0) continue;
    put_number(shape_, static_cast<std::uint64_t>(field) + 1);
    put_number(shape_, node_id(derived.node));
    put_signed(values_, derived.value);
    if (derived.field->kind == Kind::kText) put_number(values_, text_id(derived.text));
  }
  put_number(shape_, 0);
  for (const Link& link : dissection.links) {
    put_number(shape_, static_cast<std::uint64_t>(link.kind) + 1);
    put_number(shape_, node_id(link.node));
    put_signed(values_, static_cast<std::int64_t>(number) - static_cast<std::int64_t>(link.frame));
    put_signed(values_, link.after_ns);
    if (is_answer(link.kind)) {
      add_answer(link, number);
    } else if (link.frame != 0 && link.frame < number) {
      if (next_.size() <= link.frame) next_.resize(frames_.size());
      next_[link.frame] = number;
    }
  }
  put_number(shape_, 0);
  const std::uint32_t shape = intern(shape_ids_, shapes_, as_text(shape_));
  shape_.clear();
  put_number(shape_, shape);
  values_.insert(values_.begin(), shape_.begin(), shape_.end());
  frames_[number] = keep(values_);
}

bool FrameStore::get(std::uint32_t number, Bytes frame, Dissection& dissection, Found& found) const {
  dissection.clear();
  dissection.frame = frame;
  found = {};
  if (number >= frames_.size() || frames_[number].data == nullptr) return false;
  Reader values(Bytes(frames_[number].data, frames_[number].size));
  Reader shape(as_bytes(shapes_[values.number()]));
  found.count = values.number32();
  if (found.count != 0) found.first = values.number32();
  dissection.reassembled = values.take(values.number());
  dissection.protocol = static_cast<Protocol>(shape.number());
  dissection.bus = nodes_[shape.number()].bus;
  dissection.direction = static_cast<Direction>(shape.number());
  while (const std::uint64_t layout = shape.number()) {
    Segment segment;
    segment.layout = layouts_[layout - 1];
    segment.offset = shape.number32();
    segment.length = shape.number32();
    const std::uint64_t flags = shape.number();
    segment.buffer = static_cast<Buffer>(flags & 1U);
    segment.direction = static_cast<Direction>(flags >> 1U & 3U);
    segment.guessed = (flags >> 3U & 1U) != 0;
    segment.node = nodes_[shape.number()];
    dissection.add(segment);  // looks again whether the bytes are there
  }
  while (const std::uint64_t field = shape.number()) {
    Derived derived;
    derived.field = derived_[field - 1].field;
    derived.protocol = derived_[field - 1].protocol;
    derived.node = nodes_[shape.number()];
    derived.value = values.signed_number();
    if (derived.field->kind == Kind::kText) derived.text = texts_[values.number()];
    dissection.derived.push_back(derived);
  }
  while (const std::uint64_t kind = shape.number()) {
    Link link;
    link.kind = static_cast<LinkKind>(kind - 1);
    link.node = nodes_[shape.number()];
    link.frame = static_cast<std::uint64_t>(static_cast<std::int64_t>(number) - values.signed_number());
    link.after_ns = values.signed_number();
    dissection.links.push_back(link);
  }
  return true;
}

void FrameStore::answers(std::uint32_t number, std::vector<Answer>& out) const {
  out.clear();
  const auto ends = answer_ends_.find(number);
  if (ends == answer_ends_.end()) return;
  for (std::uint32_t index = ends->second.first; index != 0; index = answer_rows_[index - 1].next) {
    const AnswerRow& row = answer_rows_[index - 1];
    out.push_back({row.kind, row.frame, row.after_ns, nodes_[row.node]});
  }
}

std::size_t FrameStore::bytes_used() const {
  std::size_t total = chunk_bytes_ + frames_.capacity() * sizeof(Blob) + next_.capacity() * sizeof(std::uint32_t) +
                      answer_rows_.capacity() * sizeof(AnswerRow);
  for (const std::string_view shape : shapes_) total += shape.size();
  return total;
}

}  // namespace servotrace::plugin
