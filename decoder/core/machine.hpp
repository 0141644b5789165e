// SPDX-License-Identifier: MIT
// State machines as tables transcribed from the manuals: one row a (state, event) pair. The constructor is evaluated by
// the compiler and refuses a table with a missing pair, a duplicate or a row without a section.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace servotrace {

// State and Event: enums whose last enumerator is kCount.
template <class State, class Event, class Action>
struct Transition {
  State from{};
  Event on{};
  State to{};
  Action action{};  // what the session does or reports on it
  std::string_view section;
};

template <class State, class Event, class Action>
class Machine {
 public:
  using Row = Transition<State, Event, Action>;
  static constexpr std::size_t kStates = static_cast<std::size_t>(State::kCount);
  static constexpr std::size_t kEvents = static_cast<std::size_t>(Event::kCount);

  consteval Machine(std::string_view name, std::array<std::string_view, kStates> state_names,
                    std::array<std::string_view, kEvents> event_names, std::array<Row, kStates * kEvents> rows)
      : name_(name), state_names_(state_names), event_names_(event_names) {
    std::array<bool, kStates * kEvents> seen{};
    for (const Row& row : rows) {
      const std::size_t place = static_cast<std::size_t>(row.from) * kEvents + static_cast<std::size_t>(row.on);
      if (row.section.empty()) throw "a transition without a section";
      if (seen[place]) throw "two transitions for one state and event, so another is missing";
      seen[place] = true;
      rows_[place] = row;
    }
    for (const std::string_view text : state_names) {
      if (text.empty()) throw "a state without a name";
    }
    for (const std::string_view text : event_names) {
      if (text.empty()) throw "an event without a name";
    }
  }

  constexpr const Row& next(State state, Event event) const {
    return rows_[static_cast<std::size_t>(state) * kEvents + static_cast<std::size_t>(event)];
  }
  constexpr std::string_view name() const { return name_; }
  constexpr std::string_view name_of(State state) const { return state_names_[static_cast<std::size_t>(state)]; }
  constexpr std::string_view name_of(Event event) const { return event_names_[static_cast<std::size_t>(event)]; }
  constexpr const auto& rows() const { return rows_; }

 private:
  std::string_view name_;
  std::array<std::string_view, kStates> state_names_;
  std::array<std::string_view, kEvents> event_names_;
  std::array<Row, kStates * kEvents> rows_{};
};

}  // namespace servotrace
