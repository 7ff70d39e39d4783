#include "gateway/sessions/serial/first_bytes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace kinebus::serial {
namespace {

using Verdict = FirstLine::Verdict;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// However the stream is cut: what is said of it in the end, and what is taken.
std::string taken(const std::string& stream, std::size_t piece) {
  FirstLine first;
  for (std::size_t i = 0; i < stream.size(); i += piece) {
    switch (first.take(bytes_of(std::string_view(stream).substr(i, piece)))) {
      case Verdict::kForeign:
        return "foreign";
      case Verdict::kHost:
        return std::string(first.bytes().begin(), first.bytes().end());
      case Verdict::kNotYet:
        break;
    }
  }
  return "waits";
}

TEST(FirstLine, WhateverABrowserSendsIsForeignBeforeALineIsTaken) {
  const std::string requests[] = {
      "POST / HTTP/1.1\r\nHost: 127.0.0.1:2323\r\nContent-Type: text/plain\r\n\r\nM104 S200\n",
      "GET /a HTTP/1.0\r\n\r\n",
      "OPTIONS * HTTP/1.1\r\n\r\n",
      "M104 /S200 HTTP/1.1\r\n\r\n",  // a method of the page's own choice
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
      "POST /" + std::string(5000, 'a') + " HTTP/1.1\r\n\r\nM104 S200\n",
      std::string("\x16\x03\x01\x02\x00\n", 6),
      std::string(3000, 'x'),
  };
  for (const std::string& request : requests)
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, request.size()})
      EXPECT_EQ(taken(request, piece), "foreign") << request.substr(0, 40) << ", pieces of " << piece;
}

TEST(FirstLine, APrintHostIsHeardFromItsFirstByte) {
  for (const std::string& line :
       {std::string("N0 M110 N0*125\n"), std::string("M105\r\n"), std::string("\n")})
    for (const std::size_t piece : {std::size_t{1}, line.size()})
      EXPECT_EQ(taken(line, piece),
                line.substr(0, piece == 1 ? line.find_first_of("\r\n") + 1 : line.size()));
}

}  // namespace
}  // namespace kinebus::serial
