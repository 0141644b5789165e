// SPDX-License-Identifier: MIT
// Standard output and standard error: results go to the one, progress and messages to the other.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "decoder/core/result.hpp"

namespace servotrace::replay {

// "servotrace: MESSAGE" on standard error, one line.
void complain(std::string_view message);
void complain(const Error& error);
// The error that kept a file from being made: its name stands behind what happened.
Error not_written(Error error, std::string_view path);

// Where results are written. A closed pipe (`| head`) is no error: what follows is dropped.
class Out {
 public:
  Out() = default;
  Out(const Out&) = delete;
  Out& operator=(const Out&) = delete;
  virtual ~Out() = default;
  virtual void write(std::string_view text) = 0;
  // Makes what was written appear now (live output).
  virtual void flush() {}
  // Must be called once at the end; reports the first error.
  virtual Result<void> finish() = 0;
  // Nobody reads any more: the caller may stop early.
  virtual bool is_closed() const { return false; }
};

// Standard output, buffered.
class StandardOut : public Out {
 public:
  StandardOut() = default;
  ~StandardOut() override;
  void write(std::string_view text) override;
  void flush() override;
  Result<void> finish() override;
  bool is_closed() const override { return closed_; }

 private:
  std::string buffer_;
  bool closed_ = false;
  int error_ = 0;  // errno of the first failed write
};

enum class When { kAuto, kAlways, kNever };

// "auto", "always", "never"; empty where the word is none of them.
std::optional<When> when_of(std::string_view word);
bool is_terminal(int descriptor);
// --color: auto follows NO_COLOR, TERM=dumb and whether `descriptor` is a terminal.
bool use_colour(When when, int descriptor);

// ANSI styles; every one is empty where colour is off.
class Style {
 public:
  explicit Style(bool on = false) : on_(on) {}
  bool is_on() const { return on_; }
  std::string_view bold() const { return on_ ? "\x1B[1m" : ""; }
  std::string_view dim() const { return on_ ? "\x1B[2m" : ""; }
  std::string_view red() const { return on_ ? "\x1B[1;31m" : ""; }
  std::string_view yellow() const { return on_ ? "\x1B[1;33m" : ""; }
  std::string_view cyan() const { return on_ ? "\x1B[1;36m" : ""; }
  std::string_view green() const { return on_ ? "\x1B[1;32m" : ""; }
  std::string_view reset() const { return on_ ? "\x1B[0m" : ""; }

 private:
  bool on_;
};

}  // namespace servotrace::replay
