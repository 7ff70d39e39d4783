#include "gateway/jobs/store/read_ahead.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <utility>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

std::string numbers(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += std::to_string(i) + "\n";
  return text;
}

std::string rest_of(ByteSource& source, std::size_t piece) {
  std::string text, buffer(piece, '\0');
  for (;;) {
    while (source.waits()) std::this_thread::yield();
    const std::size_t n = source.read(buffer);
    if (n == 0) return text;
    text.append(buffer, 0, n);
  }
}

/// A disk that answers when it is let.
class SlowDisk : public StringSource {
 public:
  SlowDisk(std::string text, std::shared_future<void> answers, std::promise<std::thread::id>* closed)
      : StringSource(std::move(text)), answers_(std::move(answers)), closed_(closed) {}
  ~SlowDisk() override { closed_->set_value(std::this_thread::get_id()); }
  SlowDisk(const SlowDisk&) = delete;
  SlowDisk& operator=(const SlowDisk&) = delete;
  std::size_t read(std::span<char> buffer) override {
    answers_.wait();
    return StringSource::read(buffer);
  }

 private:
  std::shared_future<void> answers_;
  std::promise<std::thread::id>* closed_;
};

TEST(ReadAhead, GivesTheTextAsItIsAndAgainAfterEveryRewind) {
  for (const std::size_t count : {0UL, 3UL, 200'000UL}) {
    const std::string text = numbers(count);
    ReadAhead source(std::make_unique<StringSource>(text));
    EXPECT_EQ(source.size(), text.size());
    EXPECT_EQ(rest_of(source, 1000), text);
    EXPECT_FALSE(source.waits());
    std::array<char, 8> more{};
    EXPECT_EQ(source.read(more), 0U) << "the end stays";
    for (const std::size_t taken : {0UL, 10UL, 100'000UL}) {
      ASSERT_TRUE(source.rewind());
      std::string some(std::min(taken, text.size()), '\0');
      std::size_t got = 0;
      while (got < some.size()) got += source.read(std::span(some).subspan(got));
      EXPECT_EQ(some, text.substr(0, got));
      ASSERT_TRUE(source.rewind());
      EXPECT_EQ(rest_of(source, 70'000), text);
    }
  }
}

TEST(ReadAhead, ADiskThatDoesNotAnswerHoldsUpNeitherTheQuestionNorTheEnd) {
  std::promise<void> answer;
  std::promise<std::thread::id> closed;
  const std::string text = numbers(1000);
  auto source =
      std::make_unique<ReadAhead>(std::make_unique<SlowDisk>(text, answer.get_future().share(), &closed));
  EXPECT_TRUE(source->waits());
  ASSERT_TRUE(source->rewind());
  EXPECT_TRUE(source->waits());
  source.reset();
  auto closing = closed.get_future();
  EXPECT_EQ(closing.wait_for(0s), std::future_status::timeout);
  answer.set_value();
  EXPECT_NE(closing.get(), std::this_thread::get_id()) << "closed by the thread that may wait for it";
}

TEST(ReadAhead, WhatWasLateComesWhole) {
  std::promise<void> answer;
  std::promise<std::thread::id> closed;
  const std::string text = numbers(100'000);
  {
    ReadAhead source(std::make_unique<SlowDisk>(text, answer.get_future().share(), &closed));
    EXPECT_TRUE(source.waits());
    answer.set_value();
    EXPECT_EQ(rest_of(source, 333), text);
  }
  EXPECT_NE(closed.get_future().get(), std::this_thread::get_id());
}

}  // namespace
}  // namespace kinebus
