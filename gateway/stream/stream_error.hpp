#pragma once
// What can go wrong between the planner's phases and the nodes' queues.

#include <cstdint>
#include <string>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

struct StreamError {
  enum class Kind : std::uint8_t {
    kPose,            ///< a phase leaves the machine's reach; see `pose`
    kPhaseOrder,      ///< a phase was pushed before the last one was taken, or after finish()
    kStartMismatch,   ///< the run does not start where the axis stands; amount: counts between them
    kNotAtRest,       ///< the run's first or last phase has a speed; amount: counts/s
    kSequence,        ///< a node lost a record; amount: the record it waits for
    kCheckpoint,      ///< a node's state differs from the gateway's
    kTakenOtherwise,  ///< a node has another record in its queue than was sent
    kUnderrun,        ///< a node ran out of records
    kUnknownRecord,   ///< a status names a record that was never sent
    kSilent,          ///< records sent long ago are still not accepted; amount: ms
  };
  Kind kind{};
  std::uint8_t node_id = 0;  ///< 0: none in particular
  int axis = -1;
  std::uint32_t line = 0;  ///< the job's line, where one is to blame
  double amount = 0;
  PoseError pose{};
};
Sentence to_string(const StreamError& error);

}  // namespace kinebus
