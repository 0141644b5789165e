// SPDX-License-Identifier: MIT
// Values as people read them: scale, base, name, unit; times and durations.
#include "decoder/render/value.hpp"

#include <gtest/gtest.h>

#include "tests/support/bytes.hpp"

namespace servotrace {
namespace {

constexpr ValueName kNames[] = {{1, "one"}, {3, "three"}};

TEST(ScaledText, IsExact) {
  EXPECT_EQ(scaled_text(12, {}), "12");
  EXPECT_EQ(scaled_text(-1, {1, 10}), "-0.1");
  EXPECT_EQ(scaled_text(123, {1, 10}), "12.3");
  EXPECT_EQ(scaled_text(120, {1, 10}), "12");
  EXPECT_EQ(scaled_text(7, {100, 1}), "700");
  EXPECT_EQ(scaled_text(1, {1, 3}), "0.333333333");
  EXPECT_EQ(scaled_text(2, {1, 3}), "0.666666667");
  EXPECT_EQ(scaled_text(0, {1, 10}), "0");
  EXPECT_EQ(scaled_text(INT64_MIN, {1, 1000}), "-9223372036854775.808");
  EXPECT_EQ(scaled_text(999999999, {1, 1000000000}), "0.999999999");
}

TEST(ValueText, ShowsBaseNameAndUnit) {
  EXPECT_EQ(value_text({.width = 12, .base = Base::kHex}, 0x31), "031h");
  EXPECT_EQ(value_text({.width = 8, .base = Base::kHex, .values = kNames}, 3), "03h (three)");
  EXPECT_EQ(value_text({.width = 8, .values = kNames}, 2), "2");
  EXPECT_EQ(value_text({.width = 16, .kind = Kind::kSigned, .unit = Unit::kPercent, .scale = {1, 10}}, -255),
            "-25.5 %");
  // ESB 5.4.1: PG with three decimal places, VG with one; 10 ms a unit has none.
  EXPECT_EQ(value_text({.width = 32, .scale = {1, 1000}}, 400), "0.400");
  EXPECT_EQ(value_text({.width = 32, .scale = {1, 10}}, 450), "45.0");
  EXPECT_EQ(value_text({.width = 32, .unit = Unit::kMillisecond, .scale = {10, 1}}, 3), "30 ms");
  EXPECT_EQ(value_text({.width = 32, .scale = {1, 1000000000}}, 500000000), "0.5");
  EXPECT_EQ(value_text({.width = 64}, -1), "18446744073709551615");
  EXPECT_EQ(value_text({.width = 16, .kind = Kind::kSigned, .base = Base::kHex}, -2), "FFFEh");
}

TEST(BytesText, ShowsBytesAndText) {
  EXPECT_EQ(bytes_text({.kind = Kind::kBytes}, test::hex("0A FF")), "0A FF");
  EXPECT_EQ(bytes_text({.kind = Kind::kBytes}, {}), "none");
  EXPECT_EQ(bytes_text({.kind = Kind::kText}, test::hex("41 22 5C 00 7F")), "\"A\\\"\\\\\\x00\\x7F\"");
  // SX-DSV02203 6-4: the string ends in NUL.
  EXPECT_EQ(bytes_text({.kind = Kind::kText}, test::hex("69 63 00 00")), "\"ic\"");
  EXPECT_EQ(bytes_text({.kind = Kind::kText}, test::hex("00 00 00 00")), "\"\"");
  EXPECT_EQ(bytes_text({.kind = Kind::kBytes}, test::hex("69 00")), "69 00");
}

TEST(ViolationText, SaysWhy) {
  EXPECT_EQ(violation_text({.width = 1, .reserved = true}, 1), "must be 0");
  EXPECT_EQ(violation_text({.width = 1, .reserved = true}, 0), "");
  EXPECT_EQ(violation_text({.width = 4, .values = kNames, .closed = true}, 2), "is none of the listed values");
  EXPECT_EQ(violation_text({.width = 8, .range = {1, 10}}, 11), "must be 1 to 10");
  EXPECT_EQ(violation_text({.width = 8, .scale = {1, 10}, .range = {1, 10}}, 11), "must be 0.1 to 1.0");
}

TEST(TimeText, IsUtcWithNanoseconds) {
  EXPECT_EQ(time_text(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(time_text(1'709'164'799'123'456'789), "2024-02-28T23:59:59.123456789Z");
  EXPECT_EQ(time_text(1'709'164'800'000'000'000), "2024-02-29T00:00:00.000000000Z");
  EXPECT_EQ(time_text(-1), "1969-12-31T23:59:59.999999999Z");
  EXPECT_EQ(time_text(INT64_MAX), "2262-04-11T23:47:16.854775807Z");
  EXPECT_EQ(time_text(INT64_MIN), "1677-09-21T00:12:43.145224192Z");
}

TEST(SecondsText, HasNinePlaces) {
  EXPECT_EQ(seconds_text(1'500'000'001), "1.500000001");
  EXPECT_EQ(seconds_text(-500'000'000), "-0.500000000");
  EXPECT_EQ(seconds_text(-1'000'000'000), "-1.000000000");
  EXPECT_EQ(seconds_text(INT64_MIN), "-9223372036.854775808");
}

TEST(DurationText, ChoosesTheUnit) {
  EXPECT_EQ(duration_text(999), "999 ns");
  EXPECT_EQ(duration_text(83'333), "83.333 us");
  EXPECT_EQ(duration_text(500'000), "500 us");
  EXPECT_EQ(duration_text(-1'250'000), "-1.25 ms");
  EXPECT_EQ(duration_text(60'000'000'000), "60 s");
  EXPECT_EQ(duration_text(INT64_MIN), "-9223372036.854 s");
}

}  // namespace
}  // namespace servotrace
