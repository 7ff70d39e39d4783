// What stops a program or ends it: M0, M1, M2, M30 and their like.

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

bool Core::ends_program(Code code) const {
  switch (code.number) {
    case 0:
    case 1:
      return rules_->m0_ends;
    case 30:
      return block_.text.empty() || block_.text.front() == '(';
    default:
      return m_group(code.number) == MGroup::kStop && code.number != 60 && code.number != 226 &&
             code.number != 600 && code.number != 601;
  }
}

bool Core::run_stop() {
  for (int i = 0; i < block_.m_count; ++i) {
    const Code code = block_.m[static_cast<std::size_t>(i)];
    if (m_group(code.number) != MGroup::kStop) continue;
    if (ends_program(code)) {
      emit(canonical::End{});
      state_.modal.ended = true;
    } else if (code.number <= 1 || code.number == 60) {
      if (block_.text_of_m == code.number && code.number <= 1)
        emit(canonical::Message{std::string(block_.text)});
      emit(canonical::Pause{code.number == 1});
    } else if (code.number == 226 || code.number == 600 || code.number == 601) {
      if (code.number == 600) emit(canonical::Message{say("change the filament, then go on").english()});
      emit(canonical::Pause{.filament_change = code.number == 600});
    } else {
      emit(canonical::StoredJob{canonical::StoredJob::What::kDelete, std::string(block_.text), 0});
    }
  }
  return true;
}

}  // namespace kinebus::gcode
