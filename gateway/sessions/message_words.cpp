// Words of the gateway as messages: sentences, and problems made of them.

#include <utility>

#include "gateway/sessions/messages.hpp"

namespace kinebus {

std::string clean(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    bool whole = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; whole && k < length; ++k)
      whole = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (whole && length == 3) {
      const auto second = static_cast<unsigned char>(text[i + 1]);
      whole = !(lead == 0xE0 && second < 0xA0) && !(lead == 0xED && second > 0x9F);
    }
    if (whole && length == 4) {
      const auto second = static_cast<unsigned char>(text[i + 1]);
      whole = !(lead == 0xF0 && second < 0x90) && !(lead == 0xF4 && second > 0x8F);
    }
    if (whole) {
      out.append(text.substr(i, length));
      i += length;
    } else {
      out += '?';
      ++i;
    }
  }
  return out;
}

joblink::Sentence to_message(const Sentence& sentence) {
  joblink::Sentence m;
  const bool verbatim = sentence.pattern() == nullptr;
  m.set_verbatim(verbatim);
  m.set_text(verbatim ? clean(sentence) : std::string(sentence.pattern()));
  for (const Sentence& part : sentence.parts()) *m.add_parts() = to_message(part);
  return m;
}

joblink::Problem problem(joblink::ErrorCode code, const std::string& place, const Sentence& rule,
                         const Sentence& expected) {
  joblink::Problem p;
  p.set_code(code);
  p.set_place(clean(place));
  p.set_rule(clean(rule));
  p.set_expected(clean(expected));
  *p.mutable_rule_said() = to_message(rule);
  if (!expected.empty()) *p.mutable_expected_said() = to_message(expected);
  return p;
}

joblink::Problem problem(const Refusal& refusal) {
  return problem(joblink::ERROR_MACHINE_STATE, {}, refusal.words);
}

joblink::Problem problem(const StoreError& error) {
  using Kind = StoreError::Kind;
  static constexpr std::pair<Kind, joblink::ErrorCode> kCodes[] = {
      {Kind::kName, joblink::ERROR_NAME},        {Kind::kNoSuchJob, joblink::ERROR_NO_SUCH_JOB},
      {Kind::kQuota, joblink::ERROR_QUOTA},      {Kind::kDiskFull, joblink::ERROR_QUOTA},
      {Kind::kReadOnly, joblink::ERROR_STORAGE}, {Kind::kChecksum, joblink::ERROR_CHECKSUM},
      {Kind::kOrder, joblink::ERROR_BAD_VALUE},  {Kind::kDisk, joblink::ERROR_STORAGE},
  };
  joblink::ErrorCode code = joblink::ERROR_STORAGE;
  for (const auto& [kind, number] : kCodes)
    if (kind == error.kind) code = number;
  return problem(code, {}, error.words);
}

}  // namespace kinebus
