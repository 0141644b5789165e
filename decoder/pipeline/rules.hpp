// SPDX-License-Identifier: MIT
// Block CP: what is wrong with the capture itself, not with the bus.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"

namespace servotrace::capture {

inline constexpr std::string_view kFormat = "servotrace RTEX capture format 1; SocketCAN";

// What makes a record malformed: argument 0 of CP104.
enum class Malformed : std::uint8_t {
  kVersion,
  kHeaderLength,
  kNodeCount,
  kTooShort,
  kTooLong,
  kCanLength,
  kCanCut,
  kCanFd,
  kCanXl,
  kCarrier
};
inline constexpr ValueName kMalformedNames[] = {
    {0, "an RTEX record header of a version other than 1"},
    {1, "an RTEX record header whose length is below 24"},
    {2, "an RTEX record with no node, or with more blocks than the 32 of the ASIC"},
    {3, "an RTEX record shorter than its header says"},
    {4, "an RTEX record longer than its header says"},
    {5, "a CAN record with more than 8 data bytes"},
    {6, "a CAN record shorter than its own length byte"},
    {7, "a CAN FD record, which DeviceNet does not have"},
    {8, "a CAN XL record, which DeviceNet does not have"},
    {9, "an RTEX record whose first bytes are not the magic RTEX"},
};

// How records were lost: argument 0 of CP103. Argument 1 is a number of records, or the sequence number found.
inline constexpr std::int64_t kLostJump = 0;
inline constexpr std::int64_t kLostBack = 1;
inline constexpr std::int64_t kLostResponse = 2;
inline constexpr std::int64_t kLostDropped = 3;
inline constexpr std::int64_t kLostOverflow = 4;
inline constexpr ValueName kLostNames[] = {
    {0, "the record sequence jumps, this many records are missing"},
    {1, "the record sequence goes back, to this number"},
    {2, "a single response record is missing between two commands"},
    {3, "the capture file counts this many dropped packets"},
    {4, "the CAN adapter reports a receive overflow"},
};

inline constexpr auto kRules = std::to_array<Rule>({
    {.id = "CP101",
     .slug = "truncated-record",
     .severity = Severity::kWarning,
     .actor = Actor::kCapture,
     .title = "A record was captured only in part",
     .message = "only {0} of {1} bytes of the record were captured",
     .section = kFormat,
     .why =
         "What the missing bytes said cannot be checked. Nothing is blamed on the bus for them: sessions restart after "
         "the record.",
     .fix = "Record with an unlimited snapshot length, and let the recorder close its file before it is copied.",
     .repeat = Repeat::kEpisode},
    {.id = "CP102",
     .slug = "time-backwards",
     .severity = Severity::kWarning,
     .actor = Actor::kCapture,
     .title = "The timestamps go backwards",
     .message = "the timestamp is {0} ms earlier than that of the frame before on the same interface",
     .arguments = {{{ArgumentFormat::kMilliseconds}}},
     .section = kFormat,
     .why = "Deadlines and cycle times cannot be judged across the step: a clock was set, or files were joined in the "
            "wrong "
            "order.",
     .fix = "Record with a monotonic clock; join recordings by time (reordercap, mergecap, or --join).",
     .repeat = Repeat::kEpisode,
     .hosts = Hosts::kOfflineOnly},
    {.id = "CP103",
     .slug = "records-lost",
     .severity = Severity::kNote,
     .actor = Actor::kCapture,
     .title = "Records were lost while recording",
     .message = "records were lost: {0} ({1})",
     .arguments = {{{ArgumentFormat::kName, kLostNames}}},
     .section = kFormat,
     .why = "Across a gap nothing can be said about the bus: rules that compare neighbouring frames restart, and a "
            "missing "
            "frame is not blamed on anybody.",
     .fix = "Give the recorder a larger buffer or a faster disk; check its drop counters.",
     .repeat = Repeat::kEach},
    {.id = "CP104",
     .slug = "malformed-record",
     .severity = Severity::kWarning,
     .actor = Actor::kCapture,
     .title = "A record is malformed",
     .message = "malformed record: {0}",
     .arguments = {{{ArgumentFormat::kName, kMalformedNames}}},
     .section = kFormat,
     .why = "The record does not follow its own format, so its bytes are shown and nothing in them is guessed.",
     .fix = "Correct the recorder: header version, length and node counts must match the blocks that follow.",
     .repeat = Repeat::kOnceNode},
    {.id = "CP105",
     .slug = "unknown-link-type",
     .severity = Severity::kNote,
     .actor = Actor::kCapture,
     .title = "Records of an unknown link type were skipped",
     .message = "records of link type {0} are not decoded and were skipped",
     .section = kFormat,
     .why = "Whatever these records hold was not checked.",
     .fix = "Record RTEX in one of its four carriers and CAN as SocketCAN, or name the user link type in the settings.",
     .repeat = Repeat::kOnceNode,
     .hosts = Hosts::kOfflineOnly},
});

}  // namespace servotrace::capture
