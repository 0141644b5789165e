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
  FileSource(std::unique_ptr<Input> input, std::string name, std::string format) : input_(std::move(input)) {
    name_ = std::move(name);
    format_ = std::move(format);
  }
  Error broken(std::uint64_t at, std::string what) const {
    return Error{name_ + ": byte " + std::to_string(at), std::move(what)};
  }
  Step fail(std::uint64_t at, std::string what) {
    error_ = broken(at, std::move(what));
    return Step::kError;
  }
  // Of a record only `captured` of `expected` bytes are there.
  Step end(std::uint64_t captured, std::uint64_t expected) {
    if (input_->failure()) return fail(input_->position() + captured, *input_->failure());
    if (captured > 0) truncation_ = Truncation{captured, expected};
    return Step::kEnd;
  }

  std::unique_ptr<Input> input_;
  std::string name_;
};

Result<std::unique_ptr<Source>> read_pcap(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_pcapng(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_candump(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_asc(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_trc(std::unique_ptr<Input> input, std::string name, std::string format);
Result<std::unique_ptr<Source>> read_csv(std::unique_ptr<Input> input, std::string name, std::string format);

}  // namespace servotrace::replay
