// SPDX-License-Identifier: MIT
// The one way in: frames are pushed in file order, findings come out. Used alike by the command line, the Wireshark
// plugin, the tests and the fuzzer. Never throws across this border except std::bad_alloc; any bytes are legal input.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "decoder/findings/repeat.hpp"
#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"
#include "decoder/pipeline/summary.hpp"

namespace servotrace {

class Pipeline {
 public:
  explicit Pipeline(const Settings& settings);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // One frame, in file order. Where `dissection` is given it is filled; it views frame.bytes and buffers of this
  // pipeline, valid until the next call of any non-const member.
  void push(const RawFrame& frame, Dissection* dissection = nullptr);
  // The user (Decode As) says that CAN of this interface is DeviceNet. Acts from the next push on.
  void assume_devicenet(std::uint32_t interface_id);

  // What only a reader of the whole file knows (rules marked offline only).
  // The capture counted drops on this interface, first seen after the frame pushed last (CP103). Count 0: perhaps some
  // (a border between joined files): what follows is compared with nothing, and nothing is reported.
  void add_dropped(std::uint32_t interface_id, std::uint64_t count);
  // The file ends inside a record, behind the frame pushed last (CP101): `captured` of `expected` bytes are there.
  void truncated_end(std::uint64_t captured, std::uint64_t expected);
  // The end: what only it shows is found now. push() must not follow.
  void finish();

  // Findings added by the last push (or by finish, add_dropped, truncated_end).
  std::span<const Finding> fresh() const;
  const Findings& findings() const;
  // True where frames of this interface were recognised as RTEX or DeviceNet.
  std::uint64_t checked_frames() const;
  Summary summary() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace servotrace
