// Any bytes on HTTP connections, in pieces of any length: nothing may crash, hang or grow without bound. The
// same bytes as a form give the same parts however they are cut.

#include <string>

#include "gateway/sessions/http/tests/fuzz_machine.hpp"
#include "gateway/sessions/http/wire/multipart.hpp"

namespace kinebus::http {
namespace {

std::string parts(std::string_view text, std::size_t piece) {
  Multipart form("B");
  std::string story;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    form.add(text.substr(at, piece));
    check(form.held_bytes() < Multipart::kMaxPartHead + piece + 100);
    for (bool more = false; !more;) {
      const Multipart::Step step = form.next();
      more = step == Multipart::Step::kMore || step == Multipart::Step::kEnd || step == Multipart::Step::kBad;
      if (step == Multipart::Step::kPart) story += "\n" + form.name() + "\t" + form.file_name().value_or("-");
      if (step == Multipart::Step::kData) story += form.data();
      if (step == Multipart::Step::kBad) return story + "\nbad";
    }
  }
  return story;
}

}  // namespace
}  // namespace kinebus::http

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string whole = http::parts(text, size + 1);
  if (whole.find("\nbad") == std::string::npos) http::check(http::parts(text, 7) == whole);

  http::FuzzMachine machine;
  for (const std::size_t piece : {size + 1, std::size_t{61}}) machine.talk(text, piece);
  http::check(machine.control.clients().empty());
  return 0;
}
