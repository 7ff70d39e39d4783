#include "protocol/joblink/frame_codec.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus::joblink {
namespace {

std::span<const std::uint8_t> text_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string text_of(const FrameView& frame) {
  return {frame.message.begin(), frame.message.end()};
}

std::vector<std::string> read_all(FrameReader& reader, const std::string& stream, std::size_t piece) {
  std::vector<std::string> messages;
  for (std::size_t i = 0; i < stream.size(); i += piece) {
    const std::string part = stream.substr(i, piece);
    reader.add(text_bytes(part));
    while (const auto frame = reader.next()) messages.push_back(text_of(*frame));
  }
  return messages;
}

TEST(FrameCodec, FramesComeOutWholeHoweverTheStreamIsCut) {
  std::string stream;
  std::vector<std::string> sent;
  for (std::uint32_t i = 0; i < 20; ++i) {
    sent.push_back(std::string(i * 7, static_cast<char>('a' + i)));
    append_frame(stream, 5, i, sent.back());
  }
  for (const std::size_t piece : {1UL, 2UL, 3UL, 23UL, 24UL, 25UL, 100UL, stream.size()}) {
    FrameReader reader;
    EXPECT_EQ(read_all(reader, stream, piece), sent) << "pieces of " << piece;
    EXPECT_EQ(reader.pending(), 0U);
    EXPECT_EQ(reader.counters().skipped_bytes, 0U);
  }
}

TEST(FrameCodec, TheChecksumIsThatOfIeee8023AtAnyLength) {
  for (std::size_t size = 0; size < 40; ++size) {
    std::string message(size, '\0'), frame;
    for (std::size_t i = 0; i < size; ++i) message[i] = static_cast<char>(i * 37 + 11);
    append_frame(frame, 1, 2, message);
    Crc32 crc;
    crc.add(text_bytes(message));
    EXPECT_EQ(get_u32_le(text_bytes(frame).subspan(16)), crc.value()) << size;
  }
}

TEST(FrameCodec, AnyBrokenByteCostsItsOwnFrameOnly) {
  std::string stream;
  append_frame(stream, 5, 1, "first");
  const std::size_t begin = stream.size();
  append_frame(stream, 5, 2, "KBJ1 second: the magic word within a message");
  const std::size_t end = stream.size();
  append_frame(stream, 5, 3, "third");
  for (std::size_t i = begin; i < end; ++i) {
    std::string broken = stream;
    broken[i] = static_cast<char>(broken[i] ^ 0x10);
    FrameReader reader;
    EXPECT_EQ(read_all(reader, broken, 11), (std::vector<std::string>{"first", "third"})) << "byte " << i;
  }
}

TEST(FrameCodec, AnyLostByteCostsItsOwnFrameOnly) {
  std::string stream;
  append_frame(stream, 5, 1, "first");
  const std::size_t begin = stream.size();
  append_frame(stream, 5, 2, "second");
  const std::size_t end = stream.size();
  append_frame(stream, 5, 3, "third");
  append_frame(stream, 5, 4, "fourth");
  for (std::size_t i = begin; i < end; ++i) {
    std::string broken = stream;
    broken.erase(i, 1);
    FrameReader reader;
    EXPECT_EQ(read_all(reader, broken, 7), (std::vector<std::string>{"first", "third", "fourth"}))
        << "byte " << i;
  }
}

TEST(FrameCodec, GarbageIsSkippedInBoundedMemory) {
  std::mt19937 random(7);
  FrameReader reader;
  for (int round = 0; round < 200; ++round) {
    std::string garbage(1000, '\0');
    for (char& c : garbage) c = "KBJ1x"[random() % 5];
    reader.add(text_bytes(garbage));
    while (reader.next()) {
    }
    EXPECT_LT(reader.pending(), kFrameHeaderBytes + 3);
  }
  std::string good(30, 'K');
  append_frame(good, 1, 9, "here");
  EXPECT_EQ(read_all(reader, good, 10), std::vector<std::string>{"here"});
}

TEST(FrameCodec, AHalfFrameWhoseRestNeverComesIsGivenUp) {
  std::string stream;
  append_frame(stream, 5, 1, std::string(60'000, 'x'));
  stream.resize(1000);
  append_frame(stream, 6, 0, "hello again");
  FrameReader reader;
  EXPECT_TRUE(read_all(reader, stream, 512).empty());
  reader.give_up();
  const auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(text_of(*frame), "hello again");
}

/// A right header whose message is wrong.
std::string false_header(std::uint32_t length) {
  std::string header;
  append_frame(header, 1, 1, {});
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  put_u32_le(std::span(bytes).subspan(4), length);
  put_u32_le(std::span(bytes).subspan(16), 0x12345678);
  Crc32 crc;
  crc.add(std::span<const std::uint8_t>(bytes).first(20));
  put_u32_le(std::span(bytes).subspan(20), crc.value());
  return {bytes.begin(), bytes.end()};
}

TEST(FrameCodec, HeadersWithinEachOtherCostNoMoreThanTheirBytes) {
  std::string stream;
  while (stream.size() < 4 * kMaxMessageBytes) stream += false_header(kMaxMessageBytes);
  append_frame(stream, 5, 1, "good");
  FrameReader reader;
  EXPECT_TRUE(read_all(reader, stream, 65'536).empty());
  reader.give_up();
  const auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(text_of(*frame), "good");
  EXPECT_LE(reader.counters().checked_bytes, FrameReader::kMaxDebt + stream.size());
}

TEST(FrameCodec, TwoLongFramesLostInARowDoNotCostTheThird) {
  std::string stream;
  for (const char* name : {"a", "b"}) {
    append_frame(stream, 5, 1, std::string(kMaxMessageBytes, *name));
    stream.pop_back();
  }
  append_frame(stream, 5, 3, std::string(kMaxMessageBytes, 'c'));
  FrameReader reader;
  EXPECT_EQ(read_all(reader, stream, 65'536), std::vector<std::string>{std::string(kMaxMessageBytes, 'c')});
}

TEST(FrameCodec, AHeaderThatStatesMoreThanTheLimitIsNone) {
  std::string stream = false_header(5000);
  append_frame(stream, 5, 0, "small");
  append_frame(stream, 5, 1, std::string(5000, 'x'));
  FrameReader reader;
  reader.limit(4096);
  EXPECT_EQ(read_all(reader, stream, 100), std::vector<std::string>{"small"});
  EXPECT_EQ(reader.counters().checked_bytes, 5U);
  reader.limit(kMaxMessageBytes);
  std::string large;
  append_frame(large, 5, 2, std::string(5000, 'y'));
  EXPECT_EQ(read_all(reader, large, 100), std::vector<std::string>{std::string(5000, 'y')});
}

TEST(FrameCodec, HalfFramesAreGivenUpAllAtOnce) {
  std::string stream;
  for (int i = 0; i < 1000; ++i) stream += false_header(kMaxMessageBytes);
  append_frame(stream, 6, 0, "hello again");
  FrameReader reader;
  EXPECT_TRUE(read_all(reader, stream, 512).empty());
  reader.give_up();
  const auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(text_of(*frame), "hello again");
  // What comes from now on is waited for as before.
  std::string later;
  append_frame(later, 6, 1, std::string(3000, 'z'));
  EXPECT_EQ(read_all(reader, later, 7), std::vector<std::string>{std::string(3000, 'z')});
}

TEST(FrameCodec, AMessageThatNoFrameCarriesIsRefused) {
  FrameQueue queue;
  EXPECT_FALSE(queue.begin(kMaxMessageBytes + 1));
  EXPECT_FALSE(queue.append(5, 1, std::string(kMaxMessageBytes + 1, 'x')));
  EXPECT_TRUE(queue.empty());
  EXPECT_TRUE(queue.append(5, 1, std::string(kMaxMessageBytes, 'x')));
}

TEST(SessionSequence, WhatAnEarlierSessionLeftIsDropped) {
  SessionSequence sequence;
  sequence.begin(5, 1);
  using Verdict = SessionSequence::Verdict;
  EXPECT_EQ(sequence.take({5, 1, {}}), Verdict::kNext);
  EXPECT_EQ(sequence.take({4, 2, {}}), Verdict::kStale);
  EXPECT_EQ(sequence.take({5, 3, {}}), Verdict::kGap);
  EXPECT_EQ(sequence.take({6, 0, {}}), Verdict::kBegins);
  EXPECT_EQ(SessionSequence::after(0xFFFF'FFFFU), 1U);
}

}  // namespace
}  // namespace kinebus::joblink
