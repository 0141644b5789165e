// SPDX-License-Identifier: MIT
// The compile-time proofs accept good tables and refuse each kind of bad one; slots read and write what the rows say.
#include <gtest/gtest.h>

#include <array>

#include "decoder/core/layout_check.hpp"
#include "decoder/core/slot.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace {
namespace {

constexpr std::string_view kSection = "test 1";
constexpr ValueName kModes[] = {{0, "off"}, {2, "on"}};
constexpr Field kGoodFields[] = {
    {.key = "low", .label = "Low", .first_bit = at(0, 0), .width = 5, .section = kSection},
    {.key = "mode",
     .label = "Mode",
     .first_bit = at(0, 5),
     .width = 2,
     .values = kModes,
     .closed = true,
     .section = kSection},
    {.key = "flag", .label = "Flag", .first_bit = at(0, 7), .width = 1, .kind = Kind::kBool, .section = kSection},
    {.key = "position",
     .label = "Position",
     .first_bit = at(1),
     .width = 32,
     .kind = Kind::kSigned,
     .section = kSection},
    {.key = "wide", .label = "Wide", .first_bit = at(5), .width = 16, .order = ByteOrder::kBig, .section = kSection},
    {.key = "rest",
     .label = "Rest",
     .first_bit = at(7),
     .width = 8,
     .range = {1, 10},
     .reserved = false,
     .section = kSection},
};
constexpr Layout kGood{
    .protocol = "test", .key = "good", .title = "Good", .size = 8, .fields = kGoodFields, .section = kSection};
static_assert(well_formed(kGood));

// A copy of the good rows with one change.
template <class Change>
consteval LayoutError broken(Change change) {
  std::array<Field, std::size(kGoodFields)> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i) fields[i] = kGoodFields[i];
  Layout layout = kGood;
  layout.fields = fields;
  change(layout, fields);
  return check(layout);
}

static_assert(broken([](Layout& l, auto&) { l.title = ""; }) == LayoutError::kNoTitle);
static_assert(broken([](Layout& l, auto&) { l.section = ""; }) == LayoutError::kNoSection);
static_assert(broken([](Layout& l, auto&) { l.protocol = "Test"; }) == LayoutError::kBadProtocol);
static_assert(broken([](Layout& l, auto&) { l.key = "1st"; }) == LayoutError::kBadKey);
static_assert(broken([](Layout& l, auto&) { l.size = 9; }) == LayoutError::kGap);
static_assert(broken([](Layout& l, auto&) { l.size = 7; }) == LayoutError::kOutsideSize);
static_assert(broken([](Layout&, auto& f) { f[1].key = "low"; }) == LayoutError::kDuplicateKey);
static_assert(broken([](Layout&, auto& f) { f[1].key = "Mode"; }) == LayoutError::kBadKey);
static_assert(broken([](Layout&, auto& f) { f[1].label = ""; }) == LayoutError::kNoLabel);
static_assert(broken([](Layout&, auto& f) { f[1].section = ""; }) == LayoutError::kNoSection);
static_assert(broken([](Layout&, auto& f) { f[0].width = 4; }) == LayoutError::kGap);
static_assert(broken([](Layout&, auto& f) { f[0].width = 6; }) == LayoutError::kOverlapOrOrder);
static_assert(broken([](Layout&, auto& f) { f[2].width = 2; }) == LayoutError::kBadWidth);
static_assert(broken([](Layout&, auto& f) { f[0].width = 0; }) == LayoutError::kBadWidth);
static_assert(broken([](Layout&, auto& f) { f[0].kind = Kind::kBytes; }) == LayoutError::kBadWidth);
static_assert(broken([](Layout&, auto& f) { f[3].width = 65; }) == LayoutError::kBadWidth);
static_assert(broken([](Layout&, auto& f) { f[0].order = ByteOrder::kBig; }) == LayoutError::kBadBigEndian);
static_assert(broken([](Layout&, auto& f) { f[0].scale = {1, 0}; }) == LayoutError::kBadScale);
static_assert(broken([](Layout&, auto& f) { f[1].values = {}; }) == LayoutError::kClosedWithoutValues);
static_assert(broken([](Layout&, auto& f) { f[5].range = {10, 1}; }) == LayoutError::kBadRange);
static_assert(broken([](Layout&, auto& f) { f[5].range = {0, 256}; }) == LayoutError::kBadRange);
constexpr ValueName kUnsorted[] = {{2, "on"}, {0, "off"}};
constexpr ValueName kTwice[] = {{2, "on"}, {2, "off"}};
constexpr ValueName kTooBig[] = {{4, "four"}};
constexpr ValueName kNameless[] = {{1, ""}};
static_assert(broken([](Layout&, auto& f) { f[1].values = kUnsorted; }) == LayoutError::kValuesNotSorted);
static_assert(broken([](Layout&, auto& f) { f[1].values = kTwice; }) == LayoutError::kValuesNotSorted);
static_assert(broken([](Layout&, auto& f) { f[1].values = kTooBig; }) == LayoutError::kValueDoesNotFit);
static_assert(broken([](Layout&, auto& f) { f[1].values = kNameless; }) == LayoutError::kValueWithoutName);
constexpr Field kRestFirst[] = {
    {.key = "rest", .label = "Rest", .first_bit = at(0), .width = 0, .kind = Kind::kBytes, .section = kSection},
    {.key = "low", .label = "Low", .first_bit = at(0), .width = 8, .section = kSection}};
static_assert(check(Layout{.protocol = "test", .title = "T", .size = 1, .fields = kRestFirst, .section = kSection}) ==
              LayoutError::kRestNotLast);

TEST(Slot, ReadsWhatTheRowsSay) {
  const auto bytes = test::hex("C3 18 FC FF FF 12 34 07");
  EXPECT_EQ(read(slot(kGood, "low"), bytes), 3);
  EXPECT_EQ(read(slot(kGood, "mode"), bytes), 2);
  EXPECT_EQ(read(slot(kGood, "flag"), bytes), 1);
  EXPECT_EQ(read(slot(kGood, "position"), bytes), -1000);
  EXPECT_EQ(read(slot(kGood, "wide"), bytes), 0x1234);
}

TEST(Slot, WritesOnlyItsOwnBits) {
  auto bytes = test::hex("FF FF FF FF FF FF FF FF");
  EXPECT_TRUE(write(slot(kGood, "mode"), bytes, 0));
  EXPECT_EQ(bytes, test::hex("9F FF FF FF FF FF FF FF"));
  EXPECT_TRUE(write(slot(kGood, "position"), bytes, -1000));
  EXPECT_EQ(bytes, test::hex("9F 18 FC FF FF FF FF FF"));
  EXPECT_TRUE(write(slot(kGood, "wide"), bytes, 0x1234));
  EXPECT_EQ(bytes, test::hex("9F 18 FC FF FF 12 34 FF"));
}

TEST(Slot, RefusesWhatDoesNotFit) {
  auto bytes = test::hex("00 00 00 00 00 00 00 00");
  const auto before = bytes;
  EXPECT_FALSE(write(slot(kGood, "mode"), bytes, 4));
  EXPECT_FALSE(write(slot(kGood, "low"), bytes, -1));
  EXPECT_FALSE(write(slot(kGood, "position"), bytes, std::int64_t{1} << 31));
  EXPECT_FALSE(write(slot(kGood, "position"), MutableBytes(bytes).first(4), 0));
  EXPECT_EQ(bytes, before);
}

}  // namespace
}  // namespace servotrace
