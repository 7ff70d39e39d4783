#include "gateway/sessions/http/wire/http_reader.hpp"

#include <algorithm>
#include <boost/beast/http/basic_parser.hpp>
#include <cctype>
#include <limits>

namespace kinebus::http {
namespace {

namespace beast = boost::beast;
using beast::string_view;
using beast::http::error;

std::string text_of(string_view view) {
  return {view.data(), view.size()};
}

/// What is told of a request that cannot be read.
struct Wrong {
  int status;
  const char* why;
};
Wrong wrong_of(const beast::error_code& code) {
  if (code == error::header_limit) return {431, "the head of a request has at most 16 KiB"};
  if (code == error::bad_version) return {505, "this server speaks HTTP/1.1"};
  if (code == error::bad_content_length)
    return {400, "Content-Length must be one number, and must not stand beside Transfer-Encoding"};
  if (code == error::bad_transfer_encoding) return {400, "the only Transfer-Encoding is chunked"};
  if (code == error::bad_chunk || code == error::bad_chunk_extension)
    return {400, "a chunk of the body is not as RFC 9112 wants it"};
  return {400, "this is no request of HTTP/1.1"};
}

}  // namespace

std::string_view Head::field(std::string_view name) const {
  for (const auto& [key, value] : fields)
    if (same_word(key, name)) return value;
  return {};
}

std::size_t Head::count(std::string_view name) const {
  return static_cast<std::size_t>(
      std::count_if(fields.begin(), fields.end(), [&](const auto& f) { return same_word(f.first, name); }));
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

class Reader::Parser : public beast::http::basic_parser<true> {
 public:
  Parser() {
    header_limit(static_cast<std::uint32_t>(kMaxHeadBytes));
    // Bodies are bounded by who takes them. (Boost 1.74 takes boost::none for 0 where a length is announced.)
    body_limit(std::numeric_limits<std::uint64_t>::max());
  }
  Head head;
  std::string_view piece;

 private:
  void on_request_impl(beast::http::verb, string_view method, string_view target, int,
                       beast::error_code& code) override {
    code = {};
    head.method = text_of(method);
    head.target = text_of(target);
  }
  void on_response_impl(int, string_view, int, beast::error_code& code) override { code = error::bad_method; }
  void on_field_impl(beast::http::field, string_view name, string_view value,
                     beast::error_code& code) override {
    code = {};
    head.fields.emplace_back(text_of(name), text_of(value));
  }
  void on_header_impl(beast::error_code& code) override { code = {}; }
  void on_body_init_impl(const boost::optional<std::uint64_t>&, beast::error_code& code) override {
    code = {};
  }
  std::size_t on_body_impl(string_view body, beast::error_code& code) override {
    code = {};
    piece = {body.data(), body.size()};
    return body.size();
  }
  void on_chunk_header_impl(std::uint64_t, string_view, beast::error_code& code) override { code = {}; }
  std::size_t on_chunk_body_impl(std::uint64_t, string_view body, beast::error_code& code) override {
    code = {};
    piece = {body.data(), body.size()};
    return body.size();
  }
  void on_finish_impl(beast::error_code& code) override { code = {}; }
};

Reader::Reader() : parser_(std::make_unique<Parser>()) {}
Reader::~Reader() = default;

const Head& Reader::head() const {
  return parser_->head;
}
std::string_view Reader::body() const {
  return parser_->piece;
}
bool Reader::idle() const {
  return !parser_->got_some();
}

void Reader::next() {
  parser_ = std::make_unique<Parser>();
  head_told_ = false;
}

Reader::Taken Reader::take(std::string_view bytes) {
  if (bad_status_ != 0) return {Step::kBad, 0};
  parser_->piece = {};
  std::size_t taken = 0;
  for (;;) {
    if (parser_->is_done()) return {Step::kEnd, taken};
    beast::error_code code;
    const std::string_view rest = bytes.substr(taken);
    const std::size_t count = parser_->put(boost::asio::const_buffer(rest.data(), rest.size()), code);
    taken += count;
    if (code && code != error::need_more) {
      const Wrong wrong = wrong_of(code);
      bad_status_ = wrong.status;
      bad_why_ = wrong.why;
      return {Step::kBad, taken};
    }
    if (!head_told_ && parser_->is_header_done()) {
      head_told_ = true;
      Head& head = parser_->head;
      head.keep_alive = parser_->keep_alive();
      head.chunked = parser_->chunked();
      if (const auto length = parser_->content_length()) head.content_length = *length;
      return {Step::kHead, taken};
    }
    if (!parser_->piece.empty()) return {Step::kBody, taken};
    if (code == error::need_more || (count == 0 && !parser_->is_done())) return {Step::kMore, taken};
  }
}

}  // namespace kinebus::http
