#include "gateway/io/web_folder.hpp"

#include <libdeflate.h>
#include <spdlog/spdlog.h>

#include <array>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMaxBytes = 32U << 20;

std::string type_of(const fs::path& file) {
  static constexpr std::pair<const char*, const char*> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".json", "application/json"},
      {".txt", "text/plain; charset=utf-8"},
      {".webmanifest", "application/manifest+json"}};
  for (const auto& [end, type] : kTypes)
    if (file.extension() == end) return type;
  return "application/octet-stream";
}

std::string gzip_of(const std::string& bytes) {
  static constexpr int kLevel = 9;
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  std::string packed(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()), '\0');
  packed.resize(
      libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed.size() < bytes.size() ? packed : std::string();
}

}  // namespace

std::string read_text(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

Result<http::Pages, std::string> read_pages(const fs::path& folder) {
  http::Pages pages;
  std::size_t bytes = 0;
  std::error_code wrong;
  for (fs::recursive_directory_iterator at(folder, wrong), end; !wrong && at != end; at.increment(wrong)) {
    if (!at->is_regular_file()) continue;
    http::Page page{.type = type_of(at->path()), .bytes = read_text(at->path()), .gzip = {}, .mark = {}};
    bytes += page.bytes.size();
    if (bytes > kMaxBytes) return Error<std::string>(folder.string() + " has more than 32 MiB");
    page.gzip = gzip_of(page.bytes);
    page.mark = joblink::to_hex(joblink::sha256_of(page.bytes)).substr(0, 16);
    pages[fs::relative(at->path(), folder).generic_string()] = std::move(page);
  }
  if (wrong) return Error<std::string>(folder.string() + ": " + wrong.message());
  if (!pages.contains("index.html")) return Error<std::string>(folder.string() + " has no index.html");
  return pages;
}

fs::path installed_pages() {
  std::error_code wrong;
  const fs::path program = fs::read_symlink("/proc/self/exe", wrong);
  const fs::path folder = program.parent_path().parent_path() / "share/kinebus/web";
  return fs::exists(folder / "index.html", wrong) ? folder : fs::path();
}

std::function<void(const std::string& text)> text_keeper(fs::path file) {
  return [file = std::move(file), told = std::make_shared<bool>(false)](const std::string& text) {
    const fs::path fresh = file.string() + ".new";
    std::ofstream out(fresh, std::ios::binary);
    out << text;
    out.close();
    std::error_code wrong;
    if (out) fs::rename(fresh, file, wrong);
    if ((!out || wrong) && !std::exchange(*told, true))
      spdlog::warn("{} cannot be written: what web pages keep is lost at the end", file.string());
  };
}

}  // namespace kinebus
