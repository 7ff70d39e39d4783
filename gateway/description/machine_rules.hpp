#pragma once
// What a machine file's keys must be to each other, each of them being in its own range.

#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

struct BrokenRule {
  std::vector<std::string>
      keys;  ///< the keys that the rule compares; the first is where the mistake is reported
  Sentence found;
  Sentence expected;
};

/// Every broken rule, the kinematics' own (GeometryError) included.
std::vector<BrokenRule> broken_rules(const MachineDescription& description);

}  // namespace kinebus
