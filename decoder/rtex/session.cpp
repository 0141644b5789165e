// SPDX-License-Identifier: MIT
#include "decoder/rtex/session.hpp"

#include "decoder/rtex/decode.hpp"

namespace servotrace::rtex {

struct RingSession::Impl {
  BusRef bus;
};

RingSession::RingSession(const Settings&, const BusRef& bus, Findings&) : impl_(std::make_unique<Impl>(Impl{bus})) {}
RingSession::~RingSession() = default;
void RingSession::push(const Context& context, const RecordPlace& place) {
  if (context.dissection == nullptr) return;
  const Bytes record = context.frame.bytes.subspan(place.offset, place.length);
  const bool response = read(slot(kRecord, "direction"), record) != 0;
  const auto nodes = static_cast<unsigned>(read(slot(kRecord, "node_count"), record));
  const auto wide = static_cast<std::uint32_t>(read(slot(kRecord, "wide_nodes"), record));
  auto offset = static_cast<std::uint32_t>(read(slot(kRecord, "header_length"), record));
  for (unsigned i = 0; i < nodes; ++i) {
    const BlockSize size = (wide >> i & 1U) != 0 ? BlockSize::kWide : BlockSize::kNarrow;
    const Bytes block = record.subspan(offset);
    const NodeRef node{.bus = impl_->bus,
                       .protocol = Protocol::kRtex,
                       .mac_id = static_cast<std::int16_t>(read(slot(kCommand, "mac_id"), block)),
                       .place = static_cast<std::uint8_t>(i)};
    decode_block(response ? layouts_of_response(block, size, {}) : layouts_of_command(block, size, {}),
                 place.offset + offset, node, response ? Direction::kResponse : Direction::kCommand,
                 *context.dissection);
    offset += static_cast<std::uint32_t>(size);
  }
}
void RingSession::gap() {}
void RingSession::finish(const Context&) {}
void RingSession::summarise(BusSummary&) const {}

}  // namespace servotrace::rtex
