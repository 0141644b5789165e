// SPDX-License-Identifier: MIT
// Live capture on the loopback interface, where this machine permits it.
#include "replay/capture/live.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

constexpr std::uint16_t kPort = 35224;

TEST(Live, LoopbackDatagramsArrive) {
  auto opened = replay::open_live({.interface = "lo", .filter = "udp port 35224"});
  if (!opened) GTEST_SKIP() << opened.error().text();
  replay::LiveSource& source = **opened;
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(socket, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(kPort);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const Buffer payload = hex("52 54 45 58 01");
  constexpr std::size_t kDatagrams = 5;
  for (std::size_t i = 0; i < kDatagrams; ++i) {
    if (::sendto(socket, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                 sizeof address) < 0) {
      ::close(socket);
      GTEST_SKIP() << "this machine does not send on its loopback interface";
    }
  }
  // A machine that loses them must not hang the test.
  std::thread guard([&source] {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    source.stop();
  });
  RawFrame frame;
  std::size_t count = 0;
  while (count < kDatagrams && source.next(frame) == replay::Source::Step::kFrame) {
    ++count;
    EXPECT_EQ(frame.number, count);
    EXPECT_EQ(frame.link_type, LinkType::kEthernet);
    ASSERT_GE(frame.bytes.size(), 14U + 20U + 8U + payload.size());
    EXPECT_TRUE(std::equal(payload.begin(), payload.end(), frame.bytes.begin() + 42));
    EXPECT_GT(frame.time_ns, 1'600'000'000 * kSecondNs);
  }
  EXPECT_EQ(count, kDatagrams);
  EXPECT_EQ(source.next(frame), replay::Source::Step::kEnd) << "stopped by the guard";
  guard.join();
  ::close(socket);
  EXPECT_EQ(source.interfaces()[0].name, "lo");
}

TEST(Live, UnknownInterfacesAndFilters) {
  const auto missing = replay::open_live({.interface = "nosuch0", .filter = {}});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text().find("nosuch0: cannot be captured from: "), std::string::npos);
  auto filtered = replay::open_live({.interface = "lo", .filter = "no such filter ("});
  ASSERT_FALSE(filtered);
  if (filtered.error().text().find("CAP_NET_RAW") != std::string::npos) GTEST_SKIP() << filtered.error().text();
  EXPECT_NE(filtered.error().text().find("lo: the capture filter is wrong: "), std::string::npos);
}

}  // namespace
}  // namespace servotrace::test
