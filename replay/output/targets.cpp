// SPDX-License-Identifier: MIT
#include "replay/output/targets.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "replay/capture/whole_file.hpp"
#include "replay/settings/suggest.hpp"

namespace servotrace::replay {
namespace {

class FileOut : public Out {
 public:
  explicit FileOut(std::unique_ptr<WholeFile> file) : file_(std::move(file)) {}
  void write(std::string_view text) override { file_->write(text); }
  Result<void> finish() override { return file_->finish(); }

 private:
  std::unique_ptr<WholeFile> file_;
};

}  // namespace

std::string format_names() {
  std::string names;
  for (const OutputFormat& format : output_formats()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
  }
  return names;
}

Result<Targets> Targets::open(const std::vector<std::string>& words, std::string_view fallback,
                              const OutputOptions& options) {
  Targets targets;
  bool has_standard = false;
  const std::vector<std::string> only_fallback{std::string(fallback)};
  for (const std::string& word : words.empty() ? only_fallback : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const std::string file = equals == std::string::npos ? "" : word.substr(equals + 1);
    const auto formats = output_formats();
    const auto format = std::find_if(formats.begin(), formats.end(), [&](const auto& row) { return row.name == name; });
    if (format == formats.end()) {
      std::vector<std::string_view> names;
      for (const OutputFormat& row : formats) names.push_back(row.name);
      return Error{"--output",
                   fmt::format("no format '{}'{}; there are {}", name, did_you_mean(name, names), format_names())};
    }
    if (equals != std::string::npos && file.empty()) return Error{"--output " + word, "a file name is missing"};
    const bool standard = file.empty() || file == "-";
    if (standard && has_standard) {
      return Error{"--output", "two formats on standard output: give one of them a file (FORMAT=FILE)"};
    }
    Target target;
    OutputOptions own = options;
    if (standard) {
      has_standard = true;
      target.out = std::make_unique<StandardOut>();
    } else {
      Result<std::unique_ptr<WholeFile>> opened = WholeFile::create(file);
      if (!opened) return opened.error();
      target.out = std::make_unique<FileOut>(std::move(*opened));
      own.style = Style(false);
    }
    target.output = format->make(*target.out, own);
    targets.targets_.push_back(std::move(target));
  }
  return targets;
}

bool Targets::wants_evidence() const {
  return std::any_of(targets_.begin(), targets_.end(),
                     [](const Target& target) { return target.output->wants_evidence(); });
}

void Targets::begin() {
  for (const Target& target : targets_) target.output->begin();
}

void Targets::capture(const CaptureRecord& capture) {
  for (const Target& target : targets_) target.output->capture(capture);
}

void Targets::end(const RunTotals& totals) {
  for (const Target& target : targets_) target.output->end(totals);
}

Result<void> Targets::finish() {
  Result<void> first;
  for (const Target& target : targets_) {
    if (Result<void> finished = target.out->finish(); !finished && first) first = finished;
  }
  return first;
}

}  // namespace servotrace::replay
