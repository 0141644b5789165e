// SPDX-License-Identifier: MIT
#include "replay/capture/live.hpp"

#include <pcap/pcap.h>

#include <atomic>

#include "replay/capture/limits.hpp"

namespace servotrace::replay {
namespace {

constexpr int kTimeoutMs = 100;                   // frames are handed over at the latest after this time
constexpr int kBufferBytes = 16 * 1024 * 1024;    // of the kernel: several seconds of a fast ring
constexpr std::uint64_t kStatisticsEvery = 4096;  // frames between two looks at the drop counters

// libpcap numbers a few link types otherwise than files do.
LinkType link_type_of(int data_link) {
  switch (data_link) {
    case DLT_RAW:
      return LinkType::kRawIp;
    case DLT_LOOP:
      return LinkType::kLoop;
    default:
      return static_cast<LinkType>(static_cast<std::uint16_t>(data_link));
  }
}

class PcapLive final : public LiveSource {
 public:
  PcapLive(::pcap_t* handle, std::string name) : handle_(handle), name_(std::move(name)) { format_ = "live"; }
  ~PcapLive() override { ::pcap_close(handle_); }

  // Before the first next().
  Result<void> start(const std::string& filter) {
    ::pcap_set_snaplen(handle_, static_cast<int>(kMaxPacket));
    ::pcap_set_promisc(handle_, 1);
    ::pcap_set_timeout(handle_, kTimeoutMs);
    ::pcap_set_buffer_size(handle_, kBufferBytes);
    ::pcap_set_tstamp_precision(handle_, PCAP_TSTAMP_PRECISION_NANO);  // where it cannot: microseconds, seen below
    const int status = ::pcap_activate(handle_);
    if (status < 0) return Error{name_, "cannot be captured from: " + reason(status)};
    if (!filter.empty()) {
      ::bpf_program program = {};
      if (::pcap_compile(handle_, &program, filter.c_str(), 1, PCAP_NETMASK_UNKNOWN) != 0)
        return Error{name_, "the capture filter is wrong: " + std::string(::pcap_geterr(handle_))};
      const int set = ::pcap_setfilter(handle_, &program);
      ::pcap_freecode(&program);
      if (set != 0) return Error{name_, "the capture filter is not accepted: " + std::string(::pcap_geterr(handle_))};
    }
    nanoseconds_ = ::pcap_get_tstamp_precision(handle_) == PCAP_TSTAMP_PRECISION_NANO;
    link_type_ = link_type_of(::pcap_datalink(handle_));
    interfaces_.push_back({.link_type = link_type_, .name = name_, .time_resolution_ns = nanoseconds_ ? 1U : 1000U});
    return {};
  }

  Step next(RawFrame& frame) override {
    ::pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    for (;;) {
      if (stopping_.load(std::memory_order_relaxed)) return finish();
      switch (::pcap_next_ex(handle_, &header, &bytes)) {
        case 1:
          frame.number = ++number_;
          frame.time_ns =
              TimeNs{header->ts.tv_sec} * kSecondNs + TimeNs{header->ts.tv_usec} * (nanoseconds_ ? 1 : 1000);
          frame.link_type = link_type_;
          frame.interface_id = 0;
          frame.bytes = Bytes(bytes, header->caplen);
          frame.original_length = header->len;
          frame.file_order = kNative;
          frame.time_resolution_ns = nanoseconds_ ? 1U : 1000U;
          frame.has_time = true;
          if (number_ % kStatisticsEvery == 0) count_drops();
          return Step::kFrame;
        case 0:  // the timeout
          count_drops();
          break;
        case PCAP_ERROR_BREAK:
          return finish();
        default:
          error_ = Error{name_, "cannot be captured from any longer: " + std::string(::pcap_geterr(handle_))};
          return Step::kError;
      }
    }
  }

  void stop() override {
    stopping_.store(true, std::memory_order_relaxed);
    ::pcap_breakloop(handle_);
  }

 private:
  static constexpr ByteOrder kNative = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ByteOrder::kLittle : ByteOrder::kBig;

  Step finish() {
    count_drops();
    return Step::kEnd;
  }

  void count_drops() {
    ::pcap_stat statistics = {};
    if (::pcap_stats(handle_, &statistics) != 0) return;
    const unsigned total = statistics.ps_drop + statistics.ps_ifdrop;  // since the start; they wrap
    const unsigned fresh = total - dropped_total_;
    dropped_total_ = total;
    if (fresh > 0 && dropped_.size() < kMaxDropReports) dropped_.push_back({0, fresh, number_});
  }

  std::string reason(int status) const {
    const char* const more = ::pcap_geterr(handle_);
    std::string text = ::pcap_statustostr(status);
    if (status == PCAP_ERROR_PERM_DENIED) return text + " (run as root, or give the program CAP_NET_RAW)";
    if (more != nullptr && *more != '\0') text = more;
    return text;
  }

  ::pcap_t* handle_;
  std::string name_;
  LinkType link_type_ = LinkType::kEthernet;
  std::uint64_t number_ = 0;
  unsigned dropped_total_ = 0;
  bool nanoseconds_ = false;
  std::atomic<bool> stopping_ = false;
};

}  // namespace

Result<std::unique_ptr<LiveSource>> open_live(const LiveOptions& options) {
  char message[PCAP_ERRBUF_SIZE] = {};
  ::pcap_t* const handle = ::pcap_create(options.interface.c_str(), message);
  if (handle == nullptr) return Error{options.interface, "cannot be captured from: " + std::string(message)};
  auto source = std::make_unique<PcapLive>(handle, options.interface);
  const Result<void> started = source->start(options.filter);
  if (!started) return started.error();
  return std::unique_ptr<LiveSource>(std::move(source));
}

}  // namespace servotrace::replay
