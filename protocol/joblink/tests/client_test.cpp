#include "protocol/joblink/client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "protocol/joblink/job_hash.hpp"

namespace kinebus::joblink {
namespace {

using std::chrono::milliseconds;

class Text : public UploadSource {
 public:
  explicit Text(std::string text) : text_(std::move(text)) {}
  std::size_t read(std::uint64_t offset, std::span<char> buffer) override {
    if (offset >= text_.size()) return 0;
    const std::size_t n = std::min<std::size_t>(buffer.size(), text_.size() - offset);
    std::memcpy(buffer.data(), text_.data() + offset, n);
    return n;
  }

 private:
  std::string text_;
};

/// The gateway's end as far as a client sees it: hello, one upload, and errors on demand.
class FakeGateway {
 public:
  std::string stored;       ///< bytes received so far
  std::string hello_error;  ///< refuse the hello
  bool mute = false;        ///< hears, says nothing
  std::vector<ClientMessage> heard;

  void connect() { reader_.clear(); }
  std::string answer(std::span<const std::uint8_t> bytes) {
    out_.clear();
    reader_.add(bytes);
    while (const auto frame = reader_.next()) {
      if (frame->sequence == 0) {
        session_ = frame->session;
        sequence_ = 0;
      }
      ClientMessage message;
      EXPECT_TRUE(message.ParseFromArray(frame->message.data(), static_cast<int>(frame->message.size())));
      heard.push_back(message);
      if (!mute) reply_to(message);
    }
    return out_;
  }
  std::string say(const ServerMessage& message) {
    out_.clear();
    write(message);
    return out_;
  }
  void lose_a_frame() { ++sequence_; }

 private:
  void reply_to(const ClientMessage& message) {
    ServerMessage answer;
    Reply& reply = *answer.mutable_reply();
    reply.set_request_id(message.request_id());
    if (message.has_hello()) {
      if (!hello_error.empty()) {
        reply.mutable_error()->set_rule(hello_error);
      } else {
        reply.mutable_hello()->set_max_chunk_bytes(1024);
        reply.mutable_hello()->set_upload_window_bytes(4096);
      }
    } else if (message.has_upload_begin()) {
      size_ = message.upload_begin().size_bytes();
      state(reply);
    } else if (message.has_upload_chunk()) {
      if (message.upload_chunk().offset_bytes() != stored.size())
        reply.mutable_error()->set_rule("chunk out of place");
      else
        stored += message.upload_chunk().data();
      if (!reply.has_error()) state(reply);
    } else if (message.has_upload_commit()) {
      state(reply);
      reply.mutable_upload()->set_stored(stored.size() == size_);
    }
    write(answer);
  }
  void state(Reply& reply) const {
    reply.mutable_upload()->set_upload_id(1);
    reply.mutable_upload()->set_received_bytes(stored.size());
  }
  void write(const ServerMessage& message) {
    append_frame(out_, session_, sequence_, message.SerializeAsString());
    sequence_ = SessionSequence::after(sequence_);
  }
  FrameReader reader_;
  std::uint32_t session_ = 0, sequence_ = 0;
  std::uint64_t size_ = 0;
  std::string out_;
};

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class ClientTest : public ::testing::Test {
 protected:
  Client client_{{.name = "test", .version = "1", .token = {}, .session_seed = 77}};
  FakeGateway gateway_;
  LocalTime now_{0};
  std::vector<News> news_;

  /// Moves bytes until both are quiet, `piece` at a time, at most `budget` to the gateway.
  std::size_t pump(std::size_t piece = 500, std::size_t budget = SIZE_MAX) {
    std::size_t moved = 0;
    while (moved < budget) {
      const auto bytes = client_.next_bytes();
      if (bytes.empty()) break;
      const std::size_t n = std::min({bytes.size(), piece, budget - moved});
      const std::vector<std::uint8_t> copy(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
      client_.on_bytes_sent(n);
      moved += n;
      client_.on_bytes(now_, bytes_of(gateway_.answer(copy)));
      collect();
    }
    collect();
    return moved;
  }
  void collect() {
    while (auto news = client_.next_news()) news_.push_back(std::move(*news));
  }
  void connect() {
    gateway_.connect();
    client_.on_connected(now_);
    pump();
  }
  template <typename T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const News& news : news_)
      if (const T* t = std::get_if<T>(&news)) found.push_back(*t);
    return found;
  }
};

TEST_F(ClientTest, SaysHelloThenAsksForStatuses) {
  connect();
  EXPECT_TRUE(client_.connected());
  ASSERT_EQ(all<Connected>().size(), 1U);
  ASSERT_EQ(gateway_.heard.size(), 2U);
  EXPECT_EQ(gateway_.heard[0].hello().client_name(), "test");
  EXPECT_EQ(gateway_.heard[1].watch().status_hz(), 20);
}

TEST_F(ClientTest, ARequestIsAnsweredByItsId) {
  connect();
  ClientMessage hold;
  hold.mutable_hold();
  const RequestId id = client_.send(hold);
  pump();
  ASSERT_EQ(all<Answer>().size(), 1U);
  EXPECT_EQ(all<Answer>()[0].request, id);
  EXPECT_TRUE(all<Answer>()[0].ok());
}

TEST_F(ClientTest, ABrokenLinkFailsOpenRequests) {
  connect();
  gateway_.mute = true;
  ClientMessage hold;
  hold.mutable_hold();
  client_.send(hold);
  pump();
  client_.on_disconnected(now_, "unplugged");
  client_.send(hold);
  collect();
  ASSERT_EQ(all<Answer>().size(), 2U);
  EXPECT_EQ(all<Answer>()[0].reply.error().code(), ERROR_LINK_LOST);
  EXPECT_EQ(all<Answer>()[1].reply.error().code(), ERROR_LINK_LOST);
  EXPECT_EQ(all<Disconnected>().size(), 1U);
}

TEST_F(ClientTest, UploadResumesAtAnyByteWhereTheLinkBreaks) {
  std::string text(9'000, '\0');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * 31 % 251);
  for (std::size_t cut = 0; cut < 9'600; cut += 97) {
    gateway_.stored.clear();
    news_.clear();
    client_.on_disconnected(now_, "between two cases");
    connect();
    client_.upload({.name = "a.gcode", .size_bytes = text.size(), .hash = job_hash_of(text)},
                   std::make_unique<Text>(text));
    pump(333, cut);
    client_.on_disconnected(now_, "unplugged");
    connect();
    pump();
    ASSERT_EQ(gateway_.stored, text) << "cut after " << cut << " bytes";
    const auto news = all<UploadNews>();
    ASSERT_FALSE(news.empty());
    EXPECT_EQ(news.back().phase, UploadNews::Phase::kStored) << "cut after " << cut << " bytes";
  }
}

TEST_F(ClientTest, ALostFrameBeginsANewSession) {
  connect();
  gateway_.lose_a_frame();
  ServerMessage status;
  status.mutable_status();
  client_.on_bytes(now_, bytes_of(gateway_.say(status)));
  collect();
  EXPECT_FALSE(client_.connected());
  EXPECT_EQ(all<Disconnected>().size(), 1U);
  now_ = client_.next_deadline();
  client_.on_time(now_);
  pump();
  EXPECT_TRUE(client_.connected());
}

TEST_F(ClientTest, BytesOfAnEarlierSessionAreDropped) {
  connect();
  ServerMessage status;
  status.mutable_status()->set_line(1);
  const std::string old = gateway_.say(status);
  client_.on_disconnected(now_, "unplugged");
  connect();
  client_.on_bytes(now_, bytes_of(old));
  collect();
  EXPECT_TRUE(client_.connected());
  EXPECT_TRUE(all<Status>().empty());
}

TEST_F(ClientTest, ASilentGatewayIsAskedAndThenGivenUp) {
  connect();
  gateway_.mute = true;
  const std::size_t heard = gateway_.heard.size();
  for (int i = 0; i < 20 && client_.connected(); ++i) {
    now_ = client_.next_deadline();
    client_.on_time(now_);
    pump();
  }
  ASSERT_GT(gateway_.heard.size(), heard);
  EXPECT_TRUE(gateway_.heard[heard].has_ping());
  EXPECT_FALSE(client_.connected());
  EXPECT_EQ(now_, LocalTime{milliseconds{4000}});
}

TEST_F(ClientTest, WhoWasAwayItselfDoesNotTakeTheGatewayForSilent) {
  connect();
  // A ping, which nobody answers before the computer stands still.
  gateway_.mute = true;
  now_ = client_.next_deadline();
  client_.on_time(now_);
  pump();
  now_ += std::chrono::seconds{20};
  client_.on_time(now_);
  EXPECT_TRUE(client_.connected());
  // From then on the gateway has its whole time, no more.
  const LocalTime back = now_;
  while (client_.connected() && now_ < back + std::chrono::seconds{10}) {
    now_ = std::max(now_, client_.next_deadline());
    client_.on_time(now_);
    pump();
  }
  EXPECT_EQ(now_, back + LocalTime{milliseconds{4000}});
}

TEST_F(ClientTest, ARefusedHelloIsToldAndNotRepeated) {
  gateway_.hello_error = "wrong token";
  connect();
  ASSERT_EQ(all<Disconnected>().size(), 1U);
  EXPECT_EQ(all<Disconnected>()[0].why, "wrong token");
  EXPECT_EQ(client_.next_deadline(), LocalTime::max());
}

}  // namespace
}  // namespace kinebus::joblink
