#pragma once
// What the gateway says, in the user's language. The gateway sends its sentences as they are made: a pattern
// and its parts. The pattern is what translators see (context "Gateway"); a pattern that is not known is
// shown in English.

#include <QString>
#include <string>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class GatewayWords {
 public:
  /// `words`: the same in English, of a gateway that says no more.
  static QString said(const joblink::Sentence& sentence, const std::string& words);
  /// Place, rule and what was expected.
  static QString said(const joblink::Problem& problem);
};

}  // namespace kinebus::gui
