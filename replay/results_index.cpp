// SPDX-License-Identifier: MIT
#include "replay/results_index.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include "replay/exit_status.hpp"
#include "replay/results_reader.hpp"

namespace servotrace::replay {
namespace {

constexpr std::uint64_t kHashStart = 0xCBF29CE484222325U;

// FNV-1a, 64 bits.
std::uint64_t hash_on(std::uint64_t hash, std::string_view text) {
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3U;
  }
  return hash;
}

}  // namespace

ResultsIndex::ResultsIndex() = default;
ResultsIndex::~ResultsIndex() = default;

std::unique_ptr<std::istream> ResultsIndex::open(const File& file) const {
  if (file.is_kept) return std::make_unique<std::istringstream>(file.text);
  return std::make_unique<std::ifstream>(file.path, std::ios::binary);
}

Result<void> ResultsIndex::add(const std::string& path) {
  File file{.path = path, .text = {}};
  std::error_code code;
  const std::filesystem::file_status kind = std::filesystem::status(path, code);
  if (!std::filesystem::is_regular_file(kind) && !std::filesystem::is_directory(kind)) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) return Error{path, "cannot be opened"};
    std::ostringstream text;
    text << stream.rdbuf();
    file.text = text.str();
    file.is_kept = true;
  }
  const std::unique_ptr<std::istream> stream = open(file);
  if (!*stream || std::filesystem::is_directory(kind)) return Error{path, "cannot be opened"};
  ResultsReader reader(path);
  const std::size_t before = entries_.size();
  std::uint64_t offset = 0;
  std::uint64_t lines = 0;
  bool inside = false;  // a capture
  for (std::string line; std::getline(*stream, line); ++lines) {
    const Result<ResultsReader::Line> taken = reader.take(line);
    if (!taken) return taken.error();
    if (*taken == ResultsReader::Line::kCapture) {
      const CaptureRecord& capture = reader.capture();
      entries_.push_back({.name = capture.file,
                          .first_time_ns = capture.first_time_ns,
                          .hash = kHashStart,
                          .file = files_.size(),
                          .offset = offset,
                          .length = 0,
                          .line = lines});
    }
    offset += line.size() + 1;
    inside = *taken != ResultsReader::Line::kEnd && (inside || *taken == ResultsReader::Line::kCapture);
    if (!inside || entries_.size() == before) continue;
    entries_.back().hash = hash_on(entries_.back().hash, line);
    entries_.back().length = offset - entries_.back().offset;
  }
  if (stream->bad()) return Error{path, "cannot be read on"};
  if (Result<void> whole = reader.finish(); !whole) return whole;
  status_ = worse_status(status_, reader.status());
  files_.push_back(std::move(file));
  return {};
}

void ResultsIndex::sort() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& left, const Entry& right) {
    return std::tie(left.name, left.first_time_ns, left.hash) < std::tie(right.name, right.first_time_ns, right.hash);
  });
}

Result<CaptureRecord> ResultsIndex::read(std::size_t index) {
  const Entry& entry = entries_[index];
  const File& file = files_[entry.file];
  if (!open_stream_ || open_file_ != entry.file) {
    open_stream_ = open(file);
    open_file_ = entry.file;
  }
  std::string text(entry.length, '\0');
  open_stream_->clear();
  open_stream_->seekg(static_cast<std::streamoff>(entry.offset));
  open_stream_->read(text.data(), static_cast<std::streamsize>(text.size()));
  // The last line may lack its end.
  text.resize(static_cast<std::size_t>(open_stream_->gcount()));
  ResultsReader reader(file.path, entry.line);
  std::uint64_t hash = kHashStart;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    hash = hash_on(hash, line);
    if (const Result<ResultsReader::Line> taken = reader.take(line); !taken) return taken.error();
  }
  if (hash != entry.hash) return Error{file.path, "was changed while it was read"};
  return reader.release();
}

}  // namespace servotrace::replay
