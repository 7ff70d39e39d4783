#include "node_firmware/core/page_store.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {
namespace {

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return get_u32_le(bytes.subspan(offset));
}

using Parts = std::span<const std::span<const std::uint8_t>>;

std::uint32_t checksum(std::uint32_t sequence, std::uint32_t length, Parts parts) {
  std::array<std::uint8_t, 8> head{};
  put_u32_le(head, sequence);
  put_u32_le(std::span(head).subspan(4), length);
  Crc32 crc;
  crc.add(head);
  for (const auto part : parts) crc.add(part);
  return crc.value();
}

}  // namespace

PageStore::Page PageStore::scan(std::span<const std::uint8_t> bytes) const {
  Page page;
  // Behind the last byte that is not blank: what a cut left half programmed is never programmed again.
  std::size_t end = bytes.size();
  while (end >= 4 && word_at(bytes, end - 4) == 0xFFFF'FFFF) end -= 4;
  end = std::min(whole_units(end), bytes.size());
  page.free_from = static_cast<std::uint32_t>(end);
  for (std::size_t at = 0; at + kHeader <= end; at += 4) {
    if (word_at(bytes, at) != kMagic) continue;
    const std::uint32_t sequence = word_at(bytes, at + 4);
    const std::uint32_t length = word_at(bytes, at + 8);
    if (length > bytes.size() - at - kHeader) continue;
    const auto data = bytes.subspan(at + kHeader, length);
    if (word_at(bytes, at + 12) != checksum(sequence, length, Parts(&data, 1))) continue;
    if (!page.has_record || sequence > page.newest_sequence) {
      page.has_record = true;
      page.newest_sequence = sequence;
      page.newest_offset = static_cast<std::uint32_t>(at + kHeader);
      page.newest_length = length;
    }
    at += record_size(length) - 4;
    // Data that ends in FFh looks blank.
    page.free_from = std::max(page.free_from, static_cast<std::uint32_t>(std::min(at + 4, bytes.size())));
  }
  return page;
}

void PageStore::look() {
  for (std::size_t i = 0; i < pages_.size(); ++i) pages_[i] = scan(flash_.page(i));
  const bool second = pages_[1].has_record &&
                      (!pages_[0].has_record || pages_[1].newest_sequence > pages_[0].newest_sequence);
  active_ = second ? 1 : 0;
  looked_ = true;
}

std::span<const std::uint8_t> PageStore::load() {
  if (!looked_) look();
  const Page& page = pages_[active_];
  if (!page.has_record) return {};
  return flash_.page(active_).subspan(page.newest_offset, page.newest_length);
}

std::size_t PageStore::target(std::size_t bytes) const {
  const bool fits = pages_[active_].free_from + record_size(bytes) <= flash_.page(active_).size();
  return fits ? active_ : 1 - active_;
}

bool PageStore::save_erases(std::size_t bytes) const {
  const std::size_t to = target(bytes);
  return to != active_ && pages_[to].free_from != 0;
}

bool PageStore::prepare(std::size_t bytes) {
  if (!save_erases(bytes)) return true;
  const std::size_t to = target(bytes);
  const bool good = flash_.erase(to);
  look();
  return good && pages_[to].free_from == 0;
}

bool PageStore::save(Parts parts) {
  std::size_t size = 0;
  for (const auto part : parts) size += part.size();
  if (record_size(size) > flash_.page(0).size()) return false;
  if (!prepare(size)) return false;
  const std::size_t to = target(size);
  const Page& newest = pages_[active_];
  const std::uint32_t sequence = newest.has_record ? newest.newest_sequence + 1 : 1;
  const auto length = static_cast<std::uint32_t>(size);
  std::uint32_t offset = pages_[to].free_from;
  bool good = true;
  const auto put = [&](std::uint32_t word) {
    good = good && flash_.program(to, offset, word);
    offset += 4;
  };
  put(kMagic);
  put(sequence);
  put(length);
  put(checksum(sequence, length, parts));
  constexpr std::array<std::uint8_t, 4> kBlank{0xFF, 0xFF, 0xFF, 0xFF};
  std::array<std::uint8_t, 4> word = kBlank;
  std::size_t filled = 0;
  for (const auto part : parts)
    for (const std::uint8_t byte : part) {
      word[filled++] = byte;
      if (filled < word.size()) continue;
      put(get_u32_le(word));
      word = kBlank;
      filled = 0;
    }
  if (filled != 0) put(get_u32_le(word));
  while (offset % flash_.unit() != 0) put(0xFFFF'FFFF);
  look();
  return good && pages_[to].has_record && pages_[to].newest_sequence == sequence;
}

}  // namespace kinebus
