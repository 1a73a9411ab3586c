// Safety nets: what a step does beyond the published algorithm so that hair stays finite, bounded and on its way home.
// Each can be left out by itself, to measure what it saves (hairmesh-stress --ablate).
#pragma once

#include <array>

namespace sim {

// In use.
struct SafetyNets {
  bool parameter_limits = true;    // parameter_limits.h
  bool input_repair = true;        // state_validation.h, of the state handed over
  bool result_repair = true;       // the same, of what the step made
  bool teleport = true;            // hair carried along over jumps of the roots
  bool step_energy = true;         // energy_limit.h, limitEnergy
  bool stretch_limit = true;       // stabilize.cpp, limitStretch
  bool correction_energy = true;   // limitCorrections
  bool inversion_recovery = true;  // inversion_recovery.h
  bool reference_hair = true;      // reference_hair.h
};

// Solver::kPaper: the step as published. Only values that are not finite or absurd are repaired.
inline constexpr SafetyNets kAsPublished{false, true, true, false, false, false, false, false, false};

struct SafetyNetName {
  const char* name;
  bool SafetyNets::*on;
};
inline constexpr std::array kSafetyNets{
    SafetyNetName{"parameter-limits", &SafetyNets::parameter_limits},
    SafetyNetName{"input-repair", &SafetyNets::input_repair},
    SafetyNetName{"result-repair", &SafetyNets::result_repair},
    SafetyNetName{"teleport", &SafetyNets::teleport},
    SafetyNetName{"step-energy", &SafetyNets::step_energy},
    SafetyNetName{"stretch-limit", &SafetyNets::stretch_limit},
    SafetyNetName{"correction-energy", &SafetyNets::correction_energy},
    SafetyNetName{"inversion-recovery", &SafetyNets::inversion_recovery},
    SafetyNetName{"reference-hair", &SafetyNets::reference_hair},
};

}  // namespace sim
