// The cable's pieces over a real socket.
#include "vcan_tests/usb_port/cable_stream.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace kinebus {
namespace {

struct CableEnds {
  CableEnds() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0); }
  std::array<int, 2> ends{-1, -1};
};

TEST(CableStream, PiecesArriveAsTheyWereSentHoweverTheirBytesCome) {
  CableEnds pair;
  std::vector<std::uint8_t> bytes(1000);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  std::vector<std::uint8_t> raw{0, 0, 0, 0, 2, 7, 0, 0, 4, 7, 0xE8, 3};
  raw.insert(raw.end(), bytes.begin(), bytes.end());
  raw.insert(raw.end(), {1, 0, 0, 0});
  CableStream cable(pair.ends[0]);
  std::vector<CableStream::Piece> got;
  for (std::size_t at = 0, some = 1; at < raw.size(); at += some, some = some % 13 + 1) {
    some = std::min(some, raw.size() - at);
    ASSERT_EQ(::write(pair.ends[1], raw.data() + at, some), static_cast<ssize_t>(some));
    while (auto piece = cable.receive()) got.push_back(std::move(*piece));
  }
  ASSERT_EQ(got.size(), 4u);
  EXPECT_EQ(got[0].kind, CableStream::Kind::kPlugged);
  EXPECT_EQ(got[1].kind, CableStream::Kind::kAttached);
  EXPECT_EQ(got[1].session, 7);
  EXPECT_EQ(got[2].kind, CableStream::Kind::kData);
  EXPECT_EQ(got[2].bytes, bytes);
  EXPECT_EQ(got[3].kind, CableStream::Kind::kPulled);
  EXPECT_FALSE(cable.closed());
  ::close(pair.ends[1]);
}

TEST(CableStream, WhatIsLongerThanAPieceArrivesWhole) {
  CableEnds pair;
  CableStream from(pair.ends[0]), to(pair.ends[1]);
  const std::vector<std::uint8_t> bytes(100'000, 0x5A);
  from.send(CableStream::Kind::kData, 3, bytes);
  std::size_t whole = 0;
  while (const auto piece = to.receive()) {
    EXPECT_EQ(piece->session, 3);
    whole += piece->bytes.size();
  }
  EXPECT_EQ(whole, bytes.size());
}

TEST(CableStream, NonsenseAndAnEndWithinAPieceAreTold) {
  CableEnds pair;
  CableStream cable(pair.ends[0]);
  const std::array<std::uint8_t, 4> nonsense{9, 0, 0, 0};
  ASSERT_EQ(::write(pair.ends[1], nonsense.data(), 4), 4);
  EXPECT_FALSE(cable.receive());
  EXPECT_TRUE(cable.closed());
  EXPECT_EQ(cable.trouble(), "what came is no piece of a cable: expected a kind in 0 .. 4");
  ::close(pair.ends[1]);

  CableEnds other;
  CableStream cut(other.ends[0]);
  const std::array<std::uint8_t, 5> begun{4, 1, 9, 0, 1};
  ASSERT_EQ(::write(other.ends[1], begun.data(), 5), 5);
  ::close(other.ends[1]);
  EXPECT_FALSE(cut.receive());
  EXPECT_TRUE(cut.closed());
  EXPECT_EQ(cut.trouble(), "the stream ended within a piece");
}

TEST(CableStream, AnEndBetweenPiecesIsNoTrouble) {
  CableEnds pair;
  CableStream cable(pair.ends[0]);
  {
    CableStream peer(pair.ends[1]);
    peer.send(CableStream::Kind::kPulled, 0);
  }
  const auto piece = cable.receive();
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->kind, CableStream::Kind::kPulled);
  EXPECT_FALSE(cable.receive());
  EXPECT_TRUE(cable.closed());
  EXPECT_EQ(cable.trouble(), "");
}

}  // namespace
}  // namespace kinebus
