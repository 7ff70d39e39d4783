#pragma once
// One image kept in two flash pages, whatever moment the power goes. Images are appended as records; only
// when a page is full the other one is erased, which holds nothing but older images. A record counts when its
// CRC does, so the last whole one is in force.
//
// Record, in words: kMagic | sequence number | length in bytes | CRC-32 of those two and the data | data,
// with bytes FFh to the whole word, and to the whole unit that the flash programs at once.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinebus {

/// Flash as the store needs it. Erased bytes are FFh; a word is programmed once after an erase.
class FlashPages {
 public:
  /// Bytes that are programmed at once, 4 or more: all words of a unit come one after the other.
  virtual std::size_t unit() const { return 4; }
  virtual std::span<const std::uint8_t> page(std::size_t which) const = 0;
  /// False: it did not work.
  virtual bool erase(std::size_t which) = 0;
  virtual bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) = 0;

 protected:
  ~FlashPages() = default;
};

class PageStore {
 public:
  explicit constexpr PageStore(FlashPages& flash) : flash_(flash) {}

  /// Looks through both pages, once: milliseconds where they are large. The newest whole image; empty: none.
  std::span<const std::uint8_t> load();
  /// The next save() of so many bytes has to erase a page first, which takes its time.
  bool save_erases(std::size_t bytes) const;
  /// Erases then, while there is time, so that the save need not. False: the flash does not take it.
  bool prepare(std::size_t bytes);
  /// False: not stored; what was stored before still is.
  bool save(std::span<const std::uint8_t> image) { return save(std::span(&image, 1)); }
  /// An image in parts, one behind the other; they may be parts of the one that is stored.
  bool save(std::span<const std::span<const std::uint8_t>> parts);

 private:
  static constexpr std::uint32_t kMagic = 0x5442'4B31;
  static constexpr std::size_t kHeader = 16;
  struct Page {
    std::uint32_t free_from = 0;      // behind everything that is not blank
    std::uint32_t newest_offset = 0;  // of the record's data
    std::uint32_t newest_length = 0;
    std::uint32_t newest_sequence = 0;
    bool has_record = false;
  };
  Page scan(std::span<const std::uint8_t> bytes) const;
  std::size_t whole_units(std::size_t bytes) const {
    return (bytes + flash_.unit() - 1) / flash_.unit() * flash_.unit();
  }
  std::size_t record_size(std::size_t bytes) const { return whole_units(kHeader + (bytes + 3) / 4 * 4); }
  std::size_t target(std::size_t bytes) const;
  void look();

  FlashPages& flash_;
  std::array<Page, 2> pages_{};
  std::size_t active_ = 0;  // holds the newest image
  bool looked_ = false;     // into the pages, since the last change
};

}  // namespace kinebus
