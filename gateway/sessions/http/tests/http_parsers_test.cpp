#include <gtest/gtest.h>

#include "gateway/sessions/http/wire/http_reader.hpp"
#include "gateway/sessions/http/wire/multipart.hpp"
#include "gateway/sessions/http/wire/target.hpp"

namespace kinebus::http {
namespace {

/// What a reader makes of `text`, given in pieces: "POST /a {hello} ; ".
std::string read(const std::string& text, std::size_t piece) {
  Reader reader;
  std::string waiting, story;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    waiting += text.substr(at, piece);
    for (bool more = false; !more;) {
      const Reader::Taken taken = reader.take(waiting);
      waiting.erase(0, taken.step == Reader::Step::kBody ? 0 : taken.count);
      switch (taken.step) {
        case Reader::Step::kMore:
          more = true;
          break;
        case Reader::Step::kHead:
          story += reader.head().method + " " + reader.head().target + " ";
          break;
        case Reader::Step::kBody:
          story += reader.body();
          waiting.erase(0, taken.count);
          break;
        case Reader::Step::kEnd:
          story += " ; ";
          reader.next();
          break;
        case Reader::Step::kBad:
          return story + std::to_string(reader.bad_status());
      }
    }
  }
  return story;
}

TEST(HttpReader, RequestsAreTheSameHoweverTheirBytesCome) {
  const std::string text =
      "POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n3\r\n_it\r\n0\r\n\r\n"
      "PUT /b HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\nabc"
      "GET /c HTTP/1.1\r\nHost: x\r\n\r\n";
  for (const std::size_t piece : {1, 2, 3, 7, 64, 1000})
    EXPECT_EQ(read(text, piece), "POST /a hello_it ; PUT /b abc ; GET /c  ; ") << piece;
}

TEST(HttpReader, WhatCouldBeReadInTwoWaysIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n", "400"},
      {"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\n", "400"},
      {"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: -5\r\n\r\n", "400"},
      {"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999999999\r\n\r\n", "400"},
      {"GET / HTTP/1.1\r\nHost : x\r\n\r\n", "400"},
      {"GET /\x01 HTTP/1.1\r\nHost: x\r\n\r\n", "400"},
      {"GET / HTTP/3.1\r\nHost: x\r\n\r\n", "505"},
      {"\x16\x03\x01\x02\r\n\r\n", "400"},
  };
  for (const auto& [text, status] : cases) EXPECT_EQ(read(text, 1000), status) << text;
  EXPECT_EQ(read("PUT / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n", 1000), "PUT / 400");
  EXPECT_EQ(read("GET / HTTP/1.1\r\nHost: x\r\nA: " + std::string(20'000, 'a'), 1000), "431");
}

/// "name=data;" or "name(file)=data;" for each part.
std::string parts(const std::string& text, std::size_t piece) {
  Multipart form("B");
  std::string story;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    form.add(std::string_view(text).substr(at, piece));
    for (bool more = false; !more;) {
      switch (form.next()) {
        case Multipart::Step::kMore:
        case Multipart::Step::kEnd:
          more = true;
          break;
        case Multipart::Step::kPart:
          story += form.name() + (form.file_name() ? "(" + *form.file_name() + ")" : "") + "=";
          break;
        case Multipart::Step::kData:
          story += form.data();
          break;
        case Multipart::Step::kPartEnd:
          story += ";";
          break;
        case Multipart::Step::kBad:
          return std::string("bad: ") + form.why();
      }
    }
  }
  return story + (form.ended() ? "" : " and no end");
}

TEST(HttpMultipart, PartsAreTheSameHoweverTheirBytesCome) {
  const std::string text =
      "--B\r\nContent-Disposition: form-data; name=\"print\"\r\n\r\ntrue\r\n"
      "--B\r\nContent-Disposition: form-data; name=\"path\"\r\n\r\n\r\n"
      "--B\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a \\\"b\\\".gcode\"\r\n"
      "Content-Type: application/octet-stream\r\n\r\nG1 X1\r\n--\r\n--BX\r\n-\r\r\n--B--\r\n";
  // "--BX" is a line of the file that begins as the boundary does: RFC 2046 forbids it to who makes the form.
  for (std::size_t piece = 1; piece < 80; ++piece)
    EXPECT_EQ(parts(text, piece), "bad: a line with a boundary holds something else, too") << piece;
  std::string right = text;
  right.replace(right.find("--BX"), 4, "--AX");
  for (std::size_t piece = 1; piece < 80; ++piece)
    EXPECT_EQ(parts(right, piece), "print=true;path=;file(a \"b\".gcode)=G1 X1\r\n--\r\n--AX\r\n-\r;")
        << piece;
}

TEST(HttpMultipart, WhatIsNoFormIsRefused) {
  const std::string head = "--B\r\nContent-Disposition: form-data; ";
  EXPECT_EQ(parts(head + "name=a\r\n\r\n1\r\n--B", 5), "a=1; and no end");
  EXPECT_EQ(parts(head + "filename=a\r\n\r\n1\r\n--B--", 5), "bad: a part of the form has no name");
  EXPECT_EQ(parts(head + "name=\"a\r\n\r\n1\r\n--B--", 5),
            "bad: Content-Disposition of a part cannot be read");
  EXPECT_EQ(parts(head + std::string(5000, 'a'), 5), "bad: the head of a part has at most 4 KiB");
  EXPECT_EQ(parts(std::string(5000, 'a'), 5), "bad: the form does not begin with its boundary");
  std::string many;
  for (int i = 0; i < 40; ++i) many += head + "name=a\r\n\r\n1\r\n";
  EXPECT_EQ(parts(many + "--B--", 50), "bad: a form has at most 32 parts");
}

TEST(HttpMultipart, FileNamesInUtf8AreRead) {
  EXPECT_EQ(
      parts("--B\r\nContent-Disposition: form-data; name=file; filename=x; filename*=UTF-8''%C3%A4%20b\r\n"
            "\r\n1\r\n--B--",
            9),
      "file(\u00e4 b)=1;");
  EXPECT_EQ(boundary_of("multipart/form-data; boundary=\"a b\""), "a b");
  EXPECT_EQ(boundary_of("Multipart/Form-Data;boundary=----x"), "----x");
  EXPECT_EQ(boundary_of("multipart/form-data"), std::nullopt);
  EXPECT_EQ(boundary_of("text/plain; boundary=x"), std::nullopt);
}

TEST(HttpTarget, PiecesAreDecodedAndNoneLeadsUpwards) {
  const auto target = parse_target("//api/files/local/a%20b%2F.gcode?x=%zz");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, (std::vector<std::string>{"api", "files", "local", "a b/.gcode"}));
  EXPECT_EQ(target->query, "x=%zz");
  for (const char* bad :
       {"", "*", "api", "http://h/api", "/a/../b", "/a/%2e%2E/b", "/./a", "/%0", "/%zz", "/a%00"})
    EXPECT_FALSE(parse_target(bad)) << bad;
  EXPECT_EQ(percent_encoded("a b/\u00e4"), "a%20b%2F%C3%A4");
}

}  // namespace
}  // namespace kinebus::http
