#include "vcan_tests/emulator/cpu/elf_image.hpp"

#include <fcntl.h>
#include <libelf.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>

namespace kinebus::emulator {
namespace {

class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& file) : file_(file), opened_(file) {
    if (opened_.descriptor < 0)
      fail("cannot be read (build it: cmake --preset firmware && cmake --build --preset firmware)");
    elf_version(EV_CURRENT);
    elf_.reset(elf_begin(opened_.descriptor, ELF_C_READ, nullptr));
    const Elf32_Ehdr* header = elf_ ? elf32_getehdr(elf_.get()) : nullptr;
    if (header == nullptr || header->e_ident[EI_DATA] != ELFDATA2LSB || header->e_machine != EM_ARM)
      fail("expected a little-endian 32-bit ARM ELF file");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ": " + what);
  }
  /// What libelf gave, or the end: only a truncated file lacks what its header names.
  template <typename T>
  T* need(T* found) const {
    if (found == nullptr) fail("truncated");
    return found;
  }
  Elf* get() const { return elf_.get(); }

 private:
  struct Opened {
    explicit Opened(const std::filesystem::path& file)
        : descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;
    ~Opened() {
      if (descriptor >= 0) ::close(descriptor);
    }
    int descriptor;
  };
  struct End {
    void operator()(Elf* elf) const { elf_end(elf); }
  };
  std::filesystem::path file_;
  Opened opened_;
  std::unique_ptr<Elf, End> elf_;
};

void load_pieces(const ElfFile& file, ElfImage& image) {
  std::size_t count = 0;
  if (elf_getphdrnum(file.get(), &count) != 0) file.fail("truncated");
  const Elf32_Phdr* segments = count > 0 ? file.need(elf32_getphdr(file.get())) : nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    const Elf32_Phdr& segment = segments[i];
    if (segment.p_type != PT_LOAD || segment.p_filesz == 0) continue;
    const Elf_Data* data =
        file.need(elf_getdata_rawchunk(file.get(), segment.p_offset, segment.p_filesz, ELF_T_BYTE));
    const auto* bytes = static_cast<const std::uint8_t*>(data->d_buf);
    image.pieces.push_back({segment.p_paddr, {bytes, bytes + data->d_size}});
  }
  if (image.pieces.empty()) file.fail("nothing in it to load");
}

void load_symbols(const ElfFile& file, ElfImage& image) {
  for (Elf_Scn* section = nullptr; (section = elf_nextscn(file.get(), section)) != nullptr;) {
    const Elf32_Shdr& header = *file.need(elf32_getshdr(section));
    if (header.sh_type != SHT_SYMTAB) continue;
    const Elf_Data* data = file.need(elf_getdata(section, nullptr));
    const auto* symbols = static_cast<const Elf32_Sym*>(data->d_buf);
    for (std::size_t i = 0; i < data->d_size / sizeof(Elf32_Sym); ++i) {
      const char* name = file.need(elf_strptr(file.get(), header.sh_link, symbols[i].st_name));
      if (*name != 0) image.symbols[name] = symbols[i].st_value;
    }
  }
}

}  // namespace

std::optional<std::uint32_t> ElfImage::symbol(const std::string& name) const {
  const auto found = symbols.find(name);
  if (found == symbols.end()) return std::nullopt;
  return found->second;
}

ElfImage load_elf(const std::filesystem::path& file) {
  const ElfFile elf(file);
  ElfImage image;
  load_pieces(elf, image);
  load_symbols(elf, image);
  return image;
}

}  // namespace kinebus::emulator
