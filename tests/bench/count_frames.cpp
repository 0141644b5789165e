// SPDX-License-Identifier: MIT
// The peer of the benchmarks: a bare libpcap loop that counts the frames of a file and looks at nothing.
#include <pcap/pcap.h>

#include <cstdint>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: servotrace_bench_count CAPTURE\n");
    return 2;
  }
  char message[PCAP_ERRBUF_SIZE] = {};
  pcap_t* const handle = pcap_open_offline(argv[1], message);
  if (handle == nullptr) {
    std::fprintf(stderr, "servotrace_bench_count: %s\n", message);
    return 2;
  }
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  std::uint64_t frames = 0;
  int step = 0;
  while ((step = pcap_next_ex(handle, &header, &bytes)) == 1) ++frames;
  if (step == PCAP_ERROR) std::fprintf(stderr, "servotrace_bench_count: %s\n", pcap_geterr(handle));
  pcap_close(handle);
  std::printf("%llu\n", static_cast<unsigned long long>(frames));
  return step == PCAP_ERROR ? 2 : 0;
}
