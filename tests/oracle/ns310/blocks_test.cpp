// SPDX-License-Identifier: MIT
// Command blocks of SIE-C718-7 5.5.2: one block of every command, bytes typed from Tables 5.5 to 5.16.
#include <gtest/gtest.h>

#include <string>

#include "decoder/profiles/yaskawa_ns310/blocks.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::ns310 {
namespace {

using test::hex;

std::string listing(std::string_view bytes) {
  Block block;
  if (!Blocks::set_all(block, hex(bytes), 1)) return "refused";
  BlockText text;
  append_block(text, 1, block);
  return std::string(text.view());
}

TEST(Ns310Oracle, Section552BlockOfEveryCommand) {
  // Table 5.5: class 25h, instance 1, attribute 8 becomes 1234h.
  EXPECT_EQ(listing("01 02 25 01 08 34 12 00 00"),
            "block 1: modify attribute, target_class 37, target_instance 1, attribute_number 8, attribute_value 4660, "
            "then 2");
  // Table 5.7: until 25h/13 is 128,000, for 1000 ms at most.
  EXPECT_EQ(listing("02 00 25 01 0D E8 03 00 00 00 F4 01 00"),
            "block 1: wait equals, target_class 37, target_instance 1, attribute_number 13, compare_timeout 1000, "
            "compare_data 128000, end");
  // Tables 5.9 and 5.11: to block 7 where 25h/15 is above (below) -1, else to block 3.
  EXPECT_EQ(listing("03 03 25 01 0F 07 FF FF FF FF"),
            "block 1: link if greater, target_class 37, target_instance 1, attribute_number 15, compare_link 7, "
            "compare_data -1, then 3");
  EXPECT_EQ(listing("04 03 25 01 0F 07 FF FF FF FF"),
            "block 1: link if less, target_class 37, target_instance 1, attribute_number 15, compare_link 7, "
            "compare_data -1, then 3");
  // Table 5.12, by its range; then by the data type it prints.
  EXPECT_EQ(listing("06 02 F4 01 00 00"), "block 1: delay, delay 500, then 2");
  EXPECT_EQ(listing("06 02 40"), "block 1: delay, delay 64, then 2");
  // Tables 5.13 and 5.14: to 128,000 at 8,000 steps/s.
  EXPECT_EQ(listing("07 02 00 F4 01 00 40 1F 00 00 00"),
            "block 1: trajectory, target_position 128000, target_speed 8000, incremental 0, then 2");
  EXPECT_EQ(listing("08 00 00 0C FE FF 40 1F 00 00 01"),
            "block 1: trajectory and wait, target_position -128000, target_speed 8000, incremental 1, end");
  // Table 5.15, with the code of the function table.
  EXPECT_EQ(listing("09 02 40 1F 00 00"), "block 1: speed change, target_speed 8000, then 2");
  // Table 5.16.
  EXPECT_EQ(listing("10 00 64 00 00 00 40 1F 00 00"),
            "block 1: home position travel, home_offset 100, target_speed 8000, end");
  // 05h is not defined; 00h is an empty block.
  EXPECT_EQ(listing("05 00"), "block 1: (undefined)");
  EXPECT_EQ(listing("00 00"), "block 1: (empty)");
  EXPECT_EQ(listing("09 02 40 1F 00"), "refused");
}

TEST(Ns310Oracle, Section553ChainLinkByLink) {
  Blocks blocks;
  const auto set = [&](std::uint8_t number, std::string_view bytes) {
    ASSERT_TRUE(Blocks::set_all(blocks.mutable_at(number), hex(bytes), number));
  };
  set(1, "06 03 08 00 00 00");
  set(3, "03 05 25 01 0D 07 00 00 00 00");
  set(5, "06 00 10 00 00 00");
  set(7, "06 01 18 00 00 00");
  BlockText text;
  append_chain(text, blocks, 1);
  EXPECT_EQ(
      text.view(),
      "block 1: delay, delay 8, then 3; block 3: link if greater, target_class 37, target_instance 1, "
      "attribute_number 13, compare_link 7, compare_data 0, then 5; block 5: delay, delay 16, end; block 7: delay, "
      "delay 24, then 1; again from 1");
}

}  // namespace
}  // namespace servotrace::ns310
