// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/session.hpp"

#include <bit>
#include <deque>
#include <exception>
#include <map>
#include <optional>
#include <string>

#include "decoder/pipeline/pipeline.hpp"
#include "dissector/preferences.hpp"

namespace servotrace::plugin {
namespace {

struct Session {
  explicit Session(replay::FileSettings given)
      : settings(std::move(given)), filter(settings.rules), pipeline(settings.decoder) {}
  replay::FileSettings settings;
  replay::RuleFilter filter;
  Pipeline pipeline;
  FrameStore store;
  Dissection pushed;                                                            // as the pipeline fills it
  Dissection shown;                                                             // as the store gives it back
  Dissection behind;                                                            // likewise, of another frame
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> interfaces;  // section and number to dense number
  std::vector<std::string> interface_names;  // by dense number; empty where there is none
  std::deque<std::pair<BusRef, std::string>> bus_names;
  std::uint32_t last_number = 0;
  std::int64_t last_offset = -1;
  std::vector<FrameStore::Answer> answers;
  bool failed = false;  // out of memory: what is known stays, nothing is added
};

// One file a time is what libwireshark dissects; its callbacks carry no pointer of ours.
std::unique_ptr<Session>& session() {
  static std::unique_ptr<Session> instance;
  return instance;
}

// Link types as capture files number them, for those the decoder reads. Wireshark exports only the table's other
// direction, so it is asked once for each of ours. Any other becomes a number no file uses.
LinkType link_type(const wtap_rec& rec) {
  struct Pair {
    int encapsulation;
    LinkType link_type;
  };
  static const auto kKnown = [] {
    std::vector<Pair> known;
    const auto add = [&known](int number) {
      known.push_back({wtap_pcap_encap_to_wtap_encap(number), static_cast<LinkType>(number)});
    };
    for (const LinkType type :
         {LinkType::kEthernet, LinkType::kCanSocketcan, LinkType::kWiresharkUpperPdu, LinkType::kLinuxSll,
          LinkType::kLinuxSll2, LinkType::kRawIp, LinkType::kIpv4, LinkType::kIpv6, LinkType::kNull, LinkType::kLoop})
      add(static_cast<int>(type));
    for (int user = static_cast<int>(LinkType::kUser0); user <= static_cast<int>(LinkType::kUser15); ++user) add(user);
    return known;
  }();
  const int encapsulation = rec.rec_header.packet_header.pkt_encap;
  for (const Pair& pair : kKnown) {
    if (pair.encapsulation == encapsulation) return pair.link_type;
  }
  return static_cast<LinkType>(0xFFFF);
}

// Of the interface's timestamps. Wireshark knows powers of ten only.
std::uint32_t resolution_ns(const wtap_rec& rec) {
  std::uint32_t result = 1;
  for (int digits = rec.tsprec < 0 ? 9 : rec.tsprec; digits < 9; ++digits) result *= 10;
  return result;
}

// The frame's shape; nothing where it could not be kept.
std::optional<std::uint32_t> push(Session& self, const packet_info& pinfo, Bytes bytes, std::uint32_t original_length,
                                  FrameStore::Found& found) noexcept {
  const wtap_rec& rec = *pinfo.rec;
  try {
    const std::uint32_t section = (rec.presence_flags & WTAP_HAS_SECTION_NUMBER) != 0 ? rec.section_number : 0;
    const std::uint32_t interface =
        (rec.presence_flags & WTAP_HAS_INTERFACE_ID) != 0 ? rec.rec_header.packet_header.interface_id : 0;
    const auto dense =
        self.interfaces.try_emplace({section, interface}, static_cast<std::uint32_t>(self.interfaces.size()));
    if (dense.second) {
      const char* const name = interface_name(&pinfo, interface, section);
      self.interface_names.emplace_back(name == nullptr ? "" : name);
    }
    RawFrame frame;
    frame.number = pinfo.num;
    frame.time_ns = std::int64_t{pinfo.abs_ts.secs} * kSecondNs + pinfo.abs_ts.nsecs;
    frame.link_type = link_type(rec);
    frame.interface_id = dense.first->second;
    frame.bytes = bytes;
    frame.original_length = original_length;
    // Wireshark has turned the identifiers of cooked CAN captures into the order of this machine.
    frame.file_order = std::endian::native == std::endian::little ? ByteOrder::kLittle : ByteOrder::kBig;
    frame.time_resolution_ns = resolution_ns(rec);
    frame.has_time = (rec.presence_flags & WTAP_HAS_TS) != 0;
    const auto known = static_cast<std::uint32_t>(self.pipeline.findings().all().size());
    self.pipeline.push(frame, &self.pushed);
    found = {known, static_cast<std::uint32_t>(self.pipeline.findings().all().size()) - known};
    return self.store.put(pinfo.num, self.pushed, found);
  } catch (const std::exception&) {
    self.failed = true;
    return {};
  }
}

}  // namespace

Visit visit(packet_info* pinfo) {
  static const Dissection kNothing;
  Visit result;
  result.dissection = &kNothing;
  result.number = pinfo->num;
  if (pinfo->data_src == nullptr || pinfo->rec == nullptr || pinfo->rec->rec_type != REC_TYPE_PACKET) return result;
  // The first data source is the frame itself, whatever has been reassembled or decrypted since.
  tvbuff_t* const tvb = get_data_source_tvb(static_cast<const struct data_source*>(pinfo->data_src->data));
  if (tvb == nullptr) return result;
  const std::uint32_t length = tvb_captured_length(tvb);
  const std::uint8_t* const data = length == 0 ? nullptr : tvb_get_ptr(tvb, 0, static_cast<int>(length));
  const Bytes bytes(data, length);
  result.tvb = tvb;

  if (session() == nullptr) session() = std::make_unique<Session>(current_settings());
  Session& self = *session();
  // A frame that a read filter drops leaves its number to the next one, so the number alone does not tell them apart.
  const bool is_new =
      pinfo->num > self.last_number || (pinfo->num == self.last_number && pinfo->fd->file_off != self.last_offset);
  FrameStore::Found found;
  std::optional<std::uint32_t> shape;
  if (!pinfo->fd->visited && is_new && !self.failed) {
    self.last_number = pinfo->num;
    self.last_offset = pinfo->fd->file_off;
    shape = push(self, *pinfo, bytes, tvb_reported_length(tvb), found);
  }
  // What was pushed just now need not be unpacked again.
  result.dissection = shape ? &self.pushed : &self.shown;
  result.shape = shape ? *shape : self.store.get(pinfo->num, bytes, self.shown, found);
  const std::span<const Finding> all = self.pipeline.findings().all();
  if (found.first <= all.size() && found.count <= all.size() - found.first)
    result.findings = all.subspan(found.first, found.count);
  return result;
}

std::span<const FrameStore::Answer> answers_of(std::uint32_t number) {
  Session* const self = session().get();
  if (self == nullptr) return {};
  self->store.answers(number, self->answers);
  return self->answers;
}

NextOfNode next_of_node(std::uint32_t number) {
  Session* const self = session().get();
  if (self == nullptr) return {};
  const std::uint32_t next = self->store.next_of(number);
  FrameStore::Found found;
  if (next == 0 || self->store.get(next, {}, self->behind, found) == FrameStore::kNoShape) return {};
  for (const Link& link : self->behind.links) {
    if (link.kind == LinkKind::kPreviousOfNode && link.frame == number) return {next, link.node};
  }
  return {};
}

const char* bus_text(const BusRef& bus) {
  Session* const self = session().get();
  if (self == nullptr) return "";
  std::size_t can_buses = 0;
  for (const auto& [known, name] : self->bus_names) {
    if (known == bus) return name.c_str();
    can_buses += known.kind == BusKind::kCan ? 1U : 0U;
  }
  std::string name;
  if (bus.kind == BusKind::kRing) {
    name = "ring" + std::to_string(bus.number);
  } else {
    // An interface that carries several buses (cooked "any") names none of them.
    if (bus.number == 0 && bus.interface_id < self->interface_names.size())
      name = self->interface_names[bus.interface_id];
    if (name.empty()) name = "can" + std::to_string(can_buses);
  }
  self->bus_names.emplace_back(bus, std::move(name));
  return self->bus_names.back().second.c_str();
}

const Settings* session_settings() {
  const Session* const self = session().get();
  return self == nullptr ? nullptr : &self->settings.decoder;
}

bool shown_finding(Finding& finding) {
  Session* const self = session().get();
  return rule_row(finding.rule).hosts != Hosts::kOfflineOnly && (self == nullptr || self->filter.apply(finding));
}

void reset_session() { session().reset(); }

}  // namespace servotrace::plugin
