// SPDX-License-Identifier: MIT
#include "tests/support/tshark.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/paths.hpp"
#include "tests/support/sanitized.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

Ran shell(const std::string& command) {
  Ran result;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) {
    result.status = 127;
    return result;
  }
  std::array<char, 65536> buffer;
  std::size_t size = 0;
  while ((size = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) result.out.append(buffer.data(), size);
  const int status = ::pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void let_everybody_read(const fs::path& file) {
  fs::permissions(file, fs::perms::group_read | fs::perms::others_read, fs::perm_options::add);
}

// "4.0" of "TShark (Wireshark) 4.0.17 ...".
std::string version_folder(const std::string& text) {
  for (std::size_t i = 0; i + 2 < text.size(); ++i) {
    if (text[i] < '0' || text[i] > '9') continue;
    const std::size_t first = text.find('.', i);
    const std::size_t second = first == std::string::npos ? first : text.find('.', first + 1);
    return second == std::string::npos ? std::string() : text.substr(i, second - i);
  }
  return {};
}

}  // namespace

Tshark::Tshark() {
  const fs::path plugin = binary_dir() / "plugin" / "servotrace.so";
  if (!fs::exists(plugin)) {
    why_not_ = "the plugin was not built";
    return;
  }
  const Ran version = shell("tshark --version 2>/dev/null");
  const std::string versions = version.status == 0 ? version_folder(version.out) : std::string();
  if (versions.empty()) {
    why_not_ = "there is no tshark";
    return;
  }
  std::string name = (fs::temp_directory_path() / "servotrace-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    why_not_ = "no folder for temporary files";
    return;
  }
  folder_ = name;
  ::chmod(name.c_str(), 0777);
  const fs::path place = folder_ / "plugins" / versions / "epan";
  fs::create_directories(place);
  fs::copy_file(plugin, place / "servotrace.so");
  let_everybody_read(place / "servotrace.so");
}

Tshark::~Tshark() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

fs::path Tshark::copy(const fs::path& file) const {
  const fs::path to = folder_ / file.filename();
  if (file != to) fs::copy_file(file, to, fs::copy_options::overwrite_existing);
  let_everybody_read(to);
  return to;
}

Ran Tshark::run(const std::vector<std::string>& arguments, const std::string& program,
                const std::vector<std::string>& environment) const {
  std::string command = "cd " + quoted(folder_.string()) + " && env HOME=/nonexistent XDG_CONFIG_HOME=/nonexistent";
  command += " WIRESHARK_PLUGIN_DIR=" + quoted((folder_ / "plugins").string());
  command += " WIRESHARK_ABORT_ON_DISSECTOR_BUG=1 WIRESHARK_ABORT_ON_TOO_MANY_ITEMS=1";
  // The stock program is not sanitized, so the sanitizers' library must be there before it.
  if constexpr (kSanitized) {
#if defined(__clang__)
    command += " ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD=\"$(clang -print-file-name=libclang_rt.asan-x86_64.so)\"";
#else
    command +=
        " ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD=\"$(gcc -print-file-name=libasan.so):$(gcc "
        "-print-file-name=libubsan.so)\"";
#endif
  }
  for (const std::string& setting : environment) command += " " + quoted(setting);
  if (::geteuid() == 0) command += " setpriv --reuid=65534 --regid=65534 --clear-groups";
  command += " " + quoted(program);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  const fs::path errors = folder_ / "stderr.txt";
  command += " 2>" + quoted(errors.string());
  Ran result = shell(command);
  result.err = text_of(errors);
  return result;
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    rows.push_back(parts_of(text.substr(begin, end == std::string::npos ? end : end - begin), '\t'));
    if (end == std::string::npos) break;
    begin = end + 1;
  }
  return rows;
}

}  // namespace servotrace::test
