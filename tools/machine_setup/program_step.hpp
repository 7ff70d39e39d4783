#pragma once
// Programs for boards that cannot have their role without.

#include "tools/machine_setup/role_boards.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {

/// Asks whether `board`, of without_program() and with an id, gets the role's program, and writes it. False:
/// it was not written.
bool offer_program(SetupState& state, const BoardRole& role, const BusBoard& board);
/// A boot loader hands its id on to a program, which has not stored it: it does now. False: it was told why
/// not.
bool keep_id_of_new_program(SetupState& state, NodeIds& ids, const BusBoard& board);

}  // namespace kinebus
