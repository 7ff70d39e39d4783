// Words of the gateway as messages: sentences, and problems made of them.

#include <utility>

#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {

joblink::Sentence to_message(const Sentence& sentence) {
  joblink::Sentence m;
  const bool verbatim = sentence.pattern() == nullptr;
  m.set_verbatim(verbatim);
  m.set_text(verbatim ? shown(sentence) : std::string(sentence.pattern()));
  for (const Sentence& part : sentence.parts()) *m.add_parts() = to_message(part);
  return m;
}

joblink::Problem problem(joblink::ErrorCode code, const std::string& place, const Sentence& rule,
                         const Sentence& expected) {
  joblink::Problem p;
  p.set_code(code);
  p.set_place(shown(place));
  p.set_rule(shown(rule));
  p.set_expected(shown(expected));
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
      {Kind::kBusy, joblink::ERROR_BUSY},
  };
  joblink::ErrorCode code = joblink::ERROR_STORAGE;
  for (const auto& [kind, number] : kCodes)
    if (kind == error.kind) code = number;
  return problem(code, {}, error.words);
}

}  // namespace kinebus
