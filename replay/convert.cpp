// SPDX-License-Identifier: MIT
// servotrace convert: any capture or log that is read, as pcapng; a controller's own log by a column map; RTEX records
// from one carrier into another.
#include <unistd.h>

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "decoder/link/rtex_record.hpp"
#include "replay/capture/cooked_can.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "replay/capture/rtex_log.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"

namespace servotrace::replay {
namespace {

using rtex::Carrier;

void put_be(std::vector<std::uint8_t>& to, std::uint32_t value, unsigned byte_count) {
  for (unsigned i = byte_count; i-- > 0;) to.push_back(static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU));
}

// Tag 12 (dissector name), "rtex", end tag.
void put_exported_pdu(std::vector<std::uint8_t>& to) {
  put_be(to, 12, 2);
  put_be(to, 4, 2);
  for (const char c : {'r', 't', 'e', 'x'}) to.push_back(static_cast<std::uint8_t>(c));
  put_be(to, 0, 4);
}

// A broadcast from a locally administered address.
void put_ethernet(std::vector<std::uint8_t>& to, std::uint16_t ethertype) {
  put_be(to, 0xFFFFFFFF, 4);
  put_be(to, 0xFFFF, 2);
  put_be(to, 0x02000000, 4);
  put_be(to, 1, 2);
  put_be(to, ethertype, 2);
}

// IPv4 (192.0.2.1 to 192.0.2.2, addresses for documentation) and UDP without a checksum (RFC 768 allows it).
void put_udp(std::vector<std::uint8_t>& to, std::uint16_t port, std::size_t payload) {
  const std::size_t start = to.size();
  put_be(to, 0x4500, 2);
  put_be(to, static_cast<std::uint32_t>(28 + payload), 2);
  put_be(to, 0, 4);
  put_be(to, 0x4011, 2);  // time to live 64, UDP
  put_be(to, 0, 2);
  put_be(to, 0xC0000201, 4);
  put_be(to, 0xC0000202, 4);
  std::uint32_t sum = 0;
  for (std::size_t i = start; i < start + 20; i += 2) sum += std::uint32_t{to[i]} << 8U | to[i + 1];
  while (sum > 0xFFFF) sum = (sum & 0xFFFFU) + (sum >> 16U);
  to[start + 10] = static_cast<std::uint8_t>(~sum >> 8U & 0xFFU);
  to[start + 11] = static_cast<std::uint8_t>(~sum & 0xFFU);
  put_be(to, port, 2);
  put_be(to, port, 2);
  put_be(to, static_cast<std::uint32_t>(8 + payload), 2);
  put_be(to, 0, 2);
}

class Converter {
 public:
  // `keep_resolution`: the times are as coarse as the source says, and the copy says so, too.
  Converter(PcapngWriter& writer, Carrier carrier, const RtexSettings& settings, bool keep_resolution)
      : writer_(writer), carrier_(carrier), settings_(settings), keep_resolution_(keep_resolution) {}

  void take(const RawFrame& frame, const Source& source) {
    const rtex::RecordPlace place = rtex::find_record(frame, settings_);
    const bool whole =
        place.carrier != Carrier::kNone && !place.malformed && frame.original_length <= frame.bytes.size();
    const InterfaceInfo& info = source.interfaces()[frame.interface_id];
    if (carrier_ == Carrier::kNone || !whole) {
      // Everything else keeps its bytes: a record that is cut or malformed is evidence, too.
      writer_.write(interface(frame.interface_id, frame.link_type, info), frame.time_ns,
                    as_little_endian(frame, bytes_), frame.original_length);
      return;
    }
    const Bytes record = frame.bytes.subspan(place.offset, place.length);
    bytes_.clear();
    if (carrier_ == Carrier::kExportedPdu) put_exported_pdu(bytes_);
    if (carrier_ == Carrier::kEthernet) put_ethernet(bytes_, settings_.ethertype);
    if (carrier_ == Carrier::kUdp) put_udp(bytes_, settings_.udp_port, record.size());
    bytes_.insert(bytes_.end(), record.begin(), record.end());
    writer_.write(interface(frame.interface_id, link_type(), info), frame.time_ns, bytes_,
                  static_cast<std::uint32_t>(bytes_.size()));
  }

 private:
  LinkType link_type() const {
    switch (carrier_) {
      case Carrier::kEthernet:
        return LinkType::kEthernet;
      case Carrier::kUdp:
        return LinkType::kIpv4;
      case Carrier::kUserLink:
        return static_cast<LinkType>(settings_.user_link_type);
      case Carrier::kExportedPdu:
      case Carrier::kNone:
        break;
    }
    return LinkType::kWiresharkUpperPdu;
  }

  std::uint32_t interface(std::uint32_t source_id, LinkType type, const InterfaceInfo& info) {
    const auto [entry, is_new] = interfaces_.try_emplace({source_id, type}, 0U);
    if (is_new) entry->second = writer_.add_interface(type, info.name, keep_resolution_ ? info.time_resolution_ns : 1);
    return entry->second;
  }

  PcapngWriter& writer_;
  Carrier carrier_;
  const RtexSettings& settings_;
  bool keep_resolution_;
  std::map<std::pair<std::uint32_t, LinkType>, std::uint32_t> interfaces_;
  std::vector<std::uint8_t> bytes_;
};

// What convert reads: a capture, or a controller's log by its map.
struct Opened {
  std::unique_ptr<Source> source;
  const RtexLogSource* log = nullptr;  // of `source`, where it is a log
};

Result<Opened> open_log(const CaptureInput& input, const RtexLogMap& map) {
  auto log = input.is_stream() ? open_rtex_log_stream(STDIN_FILENO, input.name, map) : open_rtex_log(input.path, map);
  if (!log) return log.error();
  const RtexLogSource* const as_log = log->get();
  return Opened{std::move(*log), as_log};
}

// --map wins; the settings' map is for what is no capture.
Result<Opened> open_for_convert(const CaptureInput& input, const std::string& map_path, const FileSettings& settings) {
  if (!map_path.empty()) {
    const Result<RtexLogMap> map = read_log_map(map_path);
    return map ? open_log(input, *map) : Result<Opened>(map.error());
  }
  Result<std::unique_ptr<Source>> source = open_input(input);
  if (source) return Opened{std::move(*source)};
  if (settings.log && !input.is_stream()) return open_log(input, *settings.log);
  return source.error();
}

}  // namespace

int run_convert(const Arguments& arguments) {
  CLI::App app(
      "Any capture or log that is read, as pcapng; a controller's own log of RTEX memories by a column map; RTEX "
      "records "
      "into another carrier.",
      "servotrace convert");
  std::string capture;
  std::string map_path;
  std::string out_path;
  std::string carrier_word = "keep";
  bool partial = false;
  CaptureOptions capture_options;
  app.add_option("IN", capture, "A capture or log, or - for standard input")->required();
  app.add_option("-o,--output", out_path, "The capture to write (.pcapng)")->required()->type_name("OUT");
  app.add_option("--carrier", carrier_word, "RTEX records: keep, pdu, ethernet, udp or user")
      ->check(CLI::IsMember({"keep", "pdu", "ethernet", "udp", "user"}))
      ->capture_default_str();
  app.add_option("--map", map_path, "IN is a log (CSV or text), and this file says which column holds what")
      ->type_name("FILE");
  app.add_flag("--partial", partial, "Of an IN that is cut or cannot be read on: write what stands before that place");
  capture_options.add_config_to(app);
  app.footer(
      "Exit status: 0 done, 2 could not do the job; without --partial nothing is written where IN cannot be read to\n"
      "its end.\n\n"
      "Examples:\n  servotrace convert candump.log -o can.pcapng\n"
      "  servotrace convert run.pcap -o run.pcapng --carrier pdu\n"
      "  servotrace convert trace.csv -o trace.pcapng --map columns.toml");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const auto fail = [](const Error& error) {
    complain(error);
    return kExitFailed;
  };
  const std::map<std::string_view, Carrier> carriers{{"keep", Carrier::kNone},
                                                     {"pdu", Carrier::kExportedPdu},
                                                     {"ethernet", Carrier::kEthernet},
                                                     {"udp", Carrier::kUdp},
                                                     {"user", Carrier::kUserLink}};
  const Result<CaptureInput> input = single_input(capture);
  if (!input) return fail(input.error());
  const auto settings = capture_options.settings(input->path);
  if (!settings) return fail(settings.error());
  const Result<Opened> opened = open_for_convert(*input, map_path, **settings);
  if (!opened) return fail(opened.error());
  Source& source = *opened->source;
  const Result<std::unique_ptr<PcapngWriter>> writer = PcapngWriter::create(out_path);
  if (!writer) return fail(writer.error());
  Converter converter(**writer, carriers.at(carrier_word), (*settings)->decoder.rtex, opened->log != nullptr);
  RawFrame frame;
  Source::Step step = Source::Step::kEnd;
  catch_interrupts();
  while (!interrupted() && (step = source.next(frame)) == Source::Step::kFrame) converter.take(frame, source);
  // A stream that is interrupted ends like a capture.
  const bool stopped = interrupted();
  if (stopped && !input->is_stream()) return fail(not_written({"", "interrupted"}, out_path));
  std::optional<Error> broken;
  if (!stopped && step == Source::Step::kError) broken = source.error();
  if (!stopped && !broken && source.truncation()) broken = Error{input->name, "ends inside a record"};
  if (broken && !partial) {
    broken->what += fmt::format("; {} is not written (--partial: write what stands before it)", out_path);
    return fail(*broken);
  }
  if (const Result<void> written = (*writer)->finish(); !written) return fail(written.error());
  if (broken) {
    broken->what += "; what stands before it was converted";
    complain(*broken);
  }
  if (opened->log != nullptr && opened->log->incomplete() != 0) {
    complain(Error{input->name, fmt::format("{} records left out: the rows of some axes are missing in their cycles",
                                            opened->log->incomplete())});
  }
  return kExitClean;
}

}  // namespace servotrace::replay
