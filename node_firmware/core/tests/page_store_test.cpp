#include "node_firmware/core/page_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "node_firmware/core/tests/flash_model.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kPage = 1024;

struct TwoPages final : FlashPages {
  explicit TwoPages(std::uint32_t seed) : flash(2 * kPage, seed) {}
  std::span<const std::uint8_t> page(std::size_t which) const override {
    return flash.bytes().subspan(which * kPage, kPage);
  }
  bool erase(std::size_t which) override {
    flash.erase(which * kPage, kPage);
    ++erasures;
    return true;
  }
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    EXPECT_LE(offset + 4, kPage);
    return flash.program(which * kPage + offset, word);
  }
  FlashModel flash;
  int erasures = 0;
};

std::vector<std::uint8_t> image(std::uint32_t number, std::size_t length) {
  std::vector<std::uint8_t> bytes(length);
  for (std::size_t i = 0; i < length; ++i)
    bytes[i] = static_cast<std::uint8_t>(i % 5 == 4 ? 0xFF : number * 7 + i);
  return bytes;
}
std::vector<std::uint8_t> loaded(FlashPages& pages) {
  PageStore store(pages);
  const auto bytes = store.load();
  return {bytes.begin(), bytes.end()};
}

TEST(PageStore, EmptyFlashHoldsNothing) {
  TwoPages pages(1);
  EXPECT_TRUE(loaded(pages).empty());
}

TEST(PageStore, TheLastImageComesBackOverManySaves) {
  TwoPages pages(1);
  PageStore store(pages);
  store.load();
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto bytes = image(i, 100 + (i * 37) % 300);
    ASSERT_TRUE(store.save(bytes));
    ASSERT_EQ(loaded(pages), bytes);
  }
  EXPECT_LT(pages.erasures, 40) << "a page takes several images before it is erased";
}

TEST(PageStore, ErasingAheadLeavesNothingToEraseWhenSaving) {
  TwoPages pages(1);
  for (std::uint32_t i = 0; i < 20; ++i) {
    PageStore store(pages);
    store.load();
    ASSERT_TRUE(store.prepare(300));
    const int before = pages.erasures;
    ASSERT_TRUE(store.save(image(i, 300)));
    EXPECT_EQ(pages.erasures, before);
  }
}

// A thousand cuts, each at any byte of a save: afterwards the old image or the new one is there, whole, and
// the next save works.
TEST(PageStore, PowerMayGoAtAnyByte) {
  std::mt19937 random(20240527);
  for (std::uint32_t round = 0; round < 1000; ++round) {
    TwoPages pages(static_cast<std::uint32_t>(random()));
    std::vector<std::uint8_t> before;
    const std::size_t saves = random() % 12;
    {
      PageStore store(pages);
      store.load();
      for (std::size_t i = 0; i < saves; ++i) {
        before = image(static_cast<std::uint32_t>(i), 50 + random() % 300);
        ASSERT_TRUE(store.save(before));
      }
    }
    const auto next = image(99, 50 + random() % 300);
    pages.flash.cut_after(static_cast<std::int64_t>(random() % 1500));
    try {
      PageStore store(pages);
      store.load();
      static_cast<void>(store.save(next));
    } catch (const PowerCut&) {
    }
    pages.flash.cut_after(-1);
    const auto after = loaded(pages);
    ASSERT_TRUE(after == before || after == next) << "round " << round;
    PageStore store(pages);
    store.load();
    const auto last = image(100, 200);
    // A torn word may refuse; then the other page takes it.
    ASSERT_TRUE(store.save(last) || store.save(last)) << "round " << round;
    ASSERT_EQ(loaded(pages), last) << "round " << round;
  }
}

// Flash that is programmed by double words, each once after an erase.
struct PairedPages final : FlashPages {
  std::span<const std::uint8_t> page(std::size_t which) const override {
    return std::span(bytes).subspan(which * kPage, kPage);
  }
  std::size_t unit() const override { return 8; }
  bool erase(std::size_t which) override {
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(which * kPage), kPage, std::uint8_t{0xFF});
    std::fill_n(written.begin() + static_cast<std::ptrdiff_t>(which * kPage / 8), kPage / 8, false);
    return true;
  }
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    const std::size_t at = which * kPage + offset;
    EXPECT_EQ(offset % 8 == 4, pending == at) << "the upper word follows the lower one";
    pending = offset % 8 == 0 ? at + 4 : kNone;
    if (offset % 8 == 4) {
      EXPECT_FALSE(written[at / 8]) << "a double word is programmed once";
      written[at / 8] = true;
    }
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
    return true;
  }
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(2 * kPage, 0xFF);
  std::vector<bool> written = std::vector<bool>(2 * kPage / 8, false);
  static constexpr std::size_t kNone = 2 * kPage;
  std::size_t pending = kNone;
};

TEST(PageStore, ProgramsWholeUnitsAndNoneTwice) {
  PairedPages pages;
  PageStore store(pages);
  static_cast<void>(store.load());
  for (std::uint32_t number = 0; number < 200; ++number) {
    const auto wanted = image(number, 1 + number * 37 % 300);
    ASSERT_TRUE(store.save(wanted)) << number;
    EXPECT_EQ(pages.pending, PairedPages::kNone) << "no half of a unit is left";
    EXPECT_EQ(loaded(pages), wanted) << number;
  }
}

}  // namespace
}  // namespace kinebus
