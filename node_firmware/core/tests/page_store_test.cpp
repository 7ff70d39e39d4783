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
    if (worn == Worn::kErasesNot) return false;
    ++erasures;
    if (worn != Worn::kErasesInVain) flash.erase(which * kPage, kPage);
    return worn != Worn::kErasesAndSaysNo;
  }
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    EXPECT_LE(offset + 4, kPage);
    EXPECT_FALSE(refused) << "what does not take a word is given no more";
    refused = words_left == 0;
    if (words_left > 0) --words_left;
    return !refused && flash.program(which * kPage + offset, word & ~stuck);
  }
  std::uint8_t byte(std::size_t at) const { return flash.bytes()[at]; }

  enum class Worn { kNot, kErasesNot, kErasesInVain, kErasesAndSaysNo };
  FlashModel flash;
  int erasures = 0;
  Worn worn = Worn::kNot;
  int words_left = -1;      ///< that it takes; < 0: all
  std::uint32_t stuck = 0;  ///< bits that are 0 whatever is programmed, and nobody says so
  bool refused = false;
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

/// A page that takes no more, and two images in it; the next one has to erase the other page.
struct FullPage {
  FullPage() {
    static_cast<void>(store.load());
    EXPECT_TRUE(store.save(image(1, 400)));
    EXPECT_TRUE(store.save(kept));
    EXPECT_TRUE(store.save_erases(400) || store.prepare(400));
    // Both have been in use: the other page holds what is older.
    for (std::uint32_t i = 2; !store.save_erases(400); ++i) EXPECT_TRUE(store.save(kept = image(i, 400)));
  }
  TwoPages pages{1};
  PageStore store{pages};
  std::vector<std::uint8_t> kept = image(9, 400);
};

TEST(PageStore, APageThatCannotBeErasedStoresNothingAndWhatIsStoredStays) {
  using Worn = TwoPages::Worn;
  for (const Worn worn : {Worn::kErasesNot, Worn::kErasesInVain, Worn::kErasesAndSaysNo}) {
    FullPage full;
    full.pages.worn = worn;
    const auto before = std::vector(full.pages.flash.bytes().begin(), full.pages.flash.bytes().end());
    EXPECT_FALSE(full.store.prepare(400));
    EXPECT_FALSE(full.store.save_erases(400) && full.store.save(image(50, 400)));
    EXPECT_EQ(loaded(full.pages), full.kept);
    if (worn != Worn::kErasesAndSaysNo) {
      EXPECT_TRUE(std::equal(before.begin(), before.end(), full.pages.flash.bytes().begin()))
          << "nothing is programmed over what is not blank";
    }
    full.pages.worn = Worn::kNot;
    EXPECT_TRUE(full.store.save(image(51, 400)));
    EXPECT_EQ(loaded(full.pages), image(51, 400));
  }
}

TEST(PageStore, AWordThatIsNotTakenEndsTheSaveAndWhatIsStoredStays) {
  for (int words = 0; words < 4 + 25; ++words) {
    TwoPages pages(1);
    PageStore store(pages);
    static_cast<void>(store.load());
    ASSERT_TRUE(store.save(image(1, 60)));
    pages.words_left = words;
    EXPECT_FALSE(store.save(image(2, 100))) << words;
    EXPECT_EQ(loaded(pages), image(1, 60)) << words;
    pages.words_left = -1;
    pages.refused = false;
    EXPECT_TRUE(store.save(image(3, 100))) << words;
    EXPECT_EQ(loaded(pages), image(3, 100)) << words;
  }
}

TEST(PageStore, BitsThatAreNotAsTheyWereProgrammedAreFoundAtOnce) {
  TwoPages pages(1);
  PageStore store(pages);
  static_cast<void>(store.load());
  pages.stuck = 0x0100;
  EXPECT_FALSE(store.save(image(0, 100)));
  EXPECT_TRUE(loaded(pages).empty());
  pages.stuck = 0;
  ASSERT_TRUE(store.save(image(1, 100)));
  pages.stuck = 0x0100;
  EXPECT_FALSE(store.save(image(2, 100)));
  EXPECT_EQ(loaded(pages), image(1, 100));
}

TEST(PageStore, AnImageIsAsLargeAsAPageAtMost) {
  TwoPages pages(1);
  PageStore store(pages);
  static_cast<void>(store.load());
  ASSERT_TRUE(store.save(image(1, 60)));
  EXPECT_FALSE(store.save(image(2, kPage - 16 + 1)));
  EXPECT_EQ(loaded(pages), image(1, 60));
  for (std::uint32_t i = 3; i < 8; ++i) {
    ASSERT_TRUE(store.save(image(i, kPage - 16))) << i;
    EXPECT_EQ(loaded(pages), image(i, kPage - 16)) << i;
  }
}

TEST(PageStore, ARecordWhoseHeadIsDamagedDoesNotCount) {
  // Of the newest record: its sequence number, its length, its data. Bits of flash fall to 0.
  for (const std::size_t at : {std::size_t{4}, std::size_t{8}, std::size_t{16}}) {
    TwoPages pages(1);
    PageStore store(pages);
    static_cast<void>(store.load());
    for (std::uint32_t i = 1; i <= 3; ++i) ASSERT_TRUE(store.save(image(i, 100)));
    const std::size_t record = 2 * (16 + 100);
    ASSERT_NE(pages.byte(record + at), 0);
    pages.flash.program(record + at, 0);
    EXPECT_EQ(loaded(pages), image(2, 100)) << at;
    for (const std::size_t before : {std::size_t{0}, record / 2}) pages.flash.program(before + at, 0);
    EXPECT_TRUE(loaded(pages).empty()) << at << ": of none";
  }
}

TEST(PageStore, NothingIsProgrammedBehindTheDataOfARecord) {
  TwoPages pages(1);
  PageStore store(pages);
  static_cast<void>(store.load());
  ASSERT_TRUE(store.save(std::vector<std::uint8_t>(21, 0x55)));
  for (std::size_t at = 16 + 21; at < 16 + 24; ++at) EXPECT_EQ(pages.byte(at), 0xFF) << at;
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
