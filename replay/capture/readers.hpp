// SPDX-License-Identifier: MIT
// The readers behind open_capture: each takes an input whose first bytes are of its kind. `format` is what
// Source::format() will say, `name` stands in messages.
#pragma once

#include <memory>
#include <string>

#include "replay/capture/input.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::replay {

// What every reader of one input has: its place in messages and how it ends.
class FileSource : public Source {
 public:
  std::uint64_t consumed() const override { return input_->consumed(); }
  std::uint64_t total() const override { return input_->total(); }

 protected:
  FileSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : input_(std::move(input)), name_(std::move(name)) {
    format_ = std::move(format);
  }
  Error broken(std::uint64_t at, std::string what) const {
    return Error{name_ + ": byte " + std::to_string(at), std::move(what)};
  }
  Step fail(std::uint64_t at, std::string what) {
    // What looks damaged may be a page that could not be read.
    error_ = broken(at, input_->lost() ? std::string(kLost) : std::move(what));
    return Step::kError;
  }
  // Touches every page of `bytes`, so that what cannot be read shows now and not in the hands of the caller. False
  // where something could not: the reader then fails.
  bool intact(Bytes bytes) const {
    constexpr std::size_t kPage = 4096;
    for (std::size_t at = kPage; at < bytes.size(); at += kPage) touch(bytes[at]);
    if (!bytes.empty()) touch(bytes.back());
    return !input_->lost();
  }
  Step fail_lost() { return fail(input_->position(), kLost); }
  // Of a record only `captured` of `expected` bytes are there.
  Step end(std::uint64_t captured, std::uint64_t expected) {
    if (input_->failure()) return fail(input_->position() + captured, *input_->failure());
    if (captured > 0) truncation_ = Truncation{captured, expected};
    return Step::kEnd;
  }

  std::unique_ptr<Input> input_;
  std::string name_;

 private:
  static void touch(const std::uint8_t& byte) {
    const volatile std::uint8_t* const place = &byte;
    static_cast<void>(*place);
  }
};

Result<std::unique_ptr<Source>> read_pcap(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_pcapng(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_candump(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_asc(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_trc(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_csv(std::unique_ptr<Input> input, std::string name, std::string format);

}  // namespace servotrace::replay
