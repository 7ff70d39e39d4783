#include "vcan_tests/emulator/cpu/elf_image.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace kinebus::emulator {
namespace {

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::vector<std::uint8_t> bytes)
      : file_(file), bytes_(std::move(bytes)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ": " + what);
  }
  std::uint32_t number(std::size_t at, std::size_t size) const {
    need(at, size);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(bytes_[at + i]) << (8 * i);
    return value;
  }
  std::vector<std::uint8_t> piece(std::size_t at, std::size_t size) const {
    need(at, size);
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at);
    return {begin, begin + static_cast<std::ptrdiff_t>(size)};
  }
  std::string text(std::size_t at) const {
    std::string out;
    for (; at < bytes_.size() && bytes_[at] != 0; ++at) out += static_cast<char>(bytes_[at]);
    return out;
  }

 private:
  void need(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) fail("truncated");
  }
  std::filesystem::path file_;
  std::vector<std::uint8_t> bytes_;
};

constexpr std::uint32_t kElfMagic = 0x464C457F, kArm = 40, kLoad = 1, kSymbolTable = 2;

}  // namespace

std::optional<std::uint32_t> ElfImage::symbol(const std::string& name) const {
  const auto found = symbols.find(name);
  if (found == symbols.end()) return std::nullopt;
  return found->second;
}

ElfImage load_elf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw std::runtime_error(
        file.string() +
        ": cannot be read (build it: cmake --preset firmware && cmake --build --preset firmware)");
  const Reader elf(file, {std::istreambuf_iterator<char>(in), {}});
  if (elf.number(0, 4) != kElfMagic || elf.number(4, 1) != 1 || elf.number(5, 1) != 1 ||
      elf.number(18, 2) != kArm)
    elf.fail("expected a little-endian 32-bit ARM ELF file");

  ElfImage image;
  const std::size_t segments = elf.number(28, 4), segment_size = elf.number(42, 2),
                    segment_count = elf.number(44, 2);
  for (std::size_t i = 0; i < segment_count; ++i) {
    const std::size_t at = segments + i * segment_size;
    const std::uint32_t size = elf.number(at + 16, 4);
    if (elf.number(at, 4) != kLoad || size == 0) continue;
    image.pieces.push_back({elf.number(at + 12, 4), elf.piece(elf.number(at + 4, 4), size)});
  }
  if (image.pieces.empty()) elf.fail("nothing in it to load");

  const std::size_t sections = elf.number(32, 4), section_size = elf.number(46, 2),
                    section_count = elf.number(48, 2);
  for (std::size_t i = 0; i < section_count; ++i) {
    const std::size_t at = sections + i * section_size;
    if (elf.number(at + 4, 4) != kSymbolTable) continue;
    const std::size_t table = elf.number(at + 16, 4), size = elf.number(at + 20, 4);
    const std::size_t names = elf.number(sections + elf.number(at + 24, 4) * section_size + 16, 4);
    for (std::size_t s = table; s + 16 <= table + size; s += 16)
      if (const std::string name = elf.text(names + elf.number(s, 4)); !name.empty())
        image.symbols[name] = elf.number(s + 4, 4);
  }
  return image;
}

}  // namespace kinebus::emulator
