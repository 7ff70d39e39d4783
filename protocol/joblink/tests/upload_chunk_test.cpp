#include "protocol/joblink/upload_chunk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::joblink {
namespace {

std::span<const std::uint8_t> message_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

ClientMessage message_of(const ChunkHead& head, const std::string& data) {
  ClientMessage message;
  message.set_request_id(head.request_id);
  message.mutable_upload_chunk()->set_upload_id(head.upload_id);
  message.mutable_upload_chunk()->set_offset_bytes(head.offset_bytes);
  message.mutable_upload_chunk()->set_data(data);
  return message;
}

TEST(UploadChunk, IsTheMessageThatTheLibraryReadsAndWrites) {
  const std::uint32_t seed = 1;
  std::mt19937_64 random(seed);
  for (int round = 0; round < 500; ++round) {
    const ChunkHead head{static_cast<std::uint32_t>(1 + (random() >> (32 + random() % 31))),
                         static_cast<std::uint32_t>(1 + (random() >> (32 + random() % 31))),
                         1 + (random() >> (1 + random() % 63))};
    std::string data(1 + random() % (1 + (1U << random() % 18)), '\0');
    for (char& c : data) c = static_cast<char>(random());
    std::vector<std::uint8_t> written(chunk_message_bytes(head, data.size()));
    const auto room = write_chunk(head, data.size(), written);
    ASSERT_EQ(room.size(), data.size());
    ASSERT_EQ(room.data() + room.size(), written.data() + written.size());
    std::copy(data.begin(), data.end(), room.begin());
    const std::string expected = message_of(head, data).SerializeAsString();
    ASSERT_EQ(std::string(written.begin(), written.end()), expected)
        << "seed " << seed << ", round " << round;
    const auto read = read_chunk(message_bytes(expected));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->head.request_id, head.request_id);
    EXPECT_EQ(read->head.upload_id, head.upload_id);
    EXPECT_EQ(read->head.offset_bytes, head.offset_bytes);
    EXPECT_EQ(read->data, data);
  }
}

TEST(UploadChunk, FieldsThatAreNotThereAreZeroAndEmpty) {
  const auto read = read_chunk(message_bytes(message_of({}, {}).SerializeAsString()));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->head.request_id, 0U);
  EXPECT_EQ(read->head.offset_bytes, 0U);
  EXPECT_TRUE(read->data.empty());
}

TEST(UploadChunk, LengthsThatTheLibraryRefusesAreNone) {
  for (const std::string& length :
       {std::string("\x80\x80\x80\x80\x80\x80\x80\x80\x00", 9), std::string("\x80\x80\x80\x80\x10"),
        std::string("\xff\xff\xff\xff\x0f")}) {
    const std::string message = "\xaa\x01" + length;
    ClientMessage parsed;
    EXPECT_FALSE(parsed.ParseFromString(message));
    EXPECT_FALSE(read_chunk(message_bytes(message)));
  }
  const std::string four("\xaa\x01\x80\x80\x80\x00", 6);  // longer than needed, but allowed
  ClientMessage parsed;
  EXPECT_TRUE(parsed.ParseFromString(four));
  EXPECT_TRUE(read_chunk(message_bytes(four)));
}

TEST(UploadChunk, OtherMessagesAndHalfOnesAreNone) {
  ClientMessage ping;
  ping.set_request_id(3);
  ping.mutable_ping();
  EXPECT_FALSE(read_chunk(message_bytes(ping.SerializeAsString())));
  EXPECT_FALSE(read_chunk({}));
  const std::string whole = message_of({7, 8, 9'000}, "G1 X1\n").SerializeAsString();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_chunk(message_bytes(whole.substr(0, size)))) << size << " bytes of " << whole.size();
}

}  // namespace
}  // namespace kinebus::joblink
