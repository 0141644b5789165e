// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "decoder/core/machine.hpp"
#include "decoder/core/small_vector.hpp"
#include "decoder/core/time.hpp"

namespace servotrace {
namespace {

enum class State { kUnknown, kOpen, kCount };
enum class Event { kOpens, kCloses, kCount };
using Door = Machine<State, Event, int>;

constexpr Door kDoor("door", {"unknown", "open"}, {"opens", "closes"},
                     {{{State::kUnknown, Event::kOpens, State::kOpen, 1, "test 1"},
                       {State::kUnknown, Event::kCloses, State::kUnknown, 2, "test 1"},
                       {State::kOpen, Event::kOpens, State::kOpen, 3, "test 1"},
                       {State::kOpen, Event::kCloses, State::kUnknown, 4, "test 1"}}});

// A machine is a constant only where its constructor did not throw: these concepts ask the compiler.
template <Event kSecond>
concept Total = requires {
  typename std::integral_constant<int, Door("door", {"unknown", "open"}, {"opens", "closes"},
                                            {{{State::kUnknown, Event::kOpens, State::kOpen, 1, "test 1"},
                                              {State::kUnknown, kSecond, State::kUnknown, 2, "test 1"},
                                              {State::kOpen, Event::kOpens, State::kOpen, 3, "test 1"},
                                              {State::kOpen, Event::kCloses, State::kUnknown, 4, "test 1"}}})
                                           .next(State::kUnknown, Event::kCloses)
                                           .action>;
};
static_assert(Total<Event::kCloses>);
static_assert(!Total<Event::kOpens>, "a duplicate, and so a missing pair, must not compile");

TEST(Machine, FollowsItsRows) {
  EXPECT_EQ(kDoor.next(State::kUnknown, Event::kOpens).to, State::kOpen);
  EXPECT_EQ(kDoor.next(State::kOpen, Event::kCloses).action, 4);
  EXPECT_EQ(kDoor.name_of(State::kOpen), "open");
  EXPECT_EQ(kDoor.name_of(Event::kCloses), "closes");
}

TEST(SmallVector, DropsAndCountsWhatDoesNotFit) {
  SmallVector<int, 2> list;
  EXPECT_TRUE(list.push_back(1));
  EXPECT_TRUE(list.push_back(2));
  EXPECT_FALSE(list.push_back(3));
  EXPECT_EQ(list.size(), 2U);
  EXPECT_EQ(list.dropped(), 1U);
  EXPECT_EQ(list.back(), 2);
  list.clear();
  EXPECT_TRUE(list.empty());
  EXPECT_EQ(list.dropped(), 0U);
}

TEST(Time, ElapsedSaturates) {
  EXPECT_EQ(elapsed_ns(100, 250), 150);
  EXPECT_EQ(elapsed_ns(250, 100), -150);
  EXPECT_EQ(elapsed_ns(INT64_MIN, INT64_MAX), INT64_MAX);
  EXPECT_EQ(elapsed_ns(INT64_MAX, INT64_MIN), INT64_MIN);
}

}  // namespace
}  // namespace servotrace
