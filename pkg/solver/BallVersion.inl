// SPDX-License-Identifier: GPL-2.0-or-later
// One version of the kernels, WIDE_LANES wide, as BALL_KERNELS.
#include "BallCertificate.inl"
#include "BallSweep.inl"

namespace contactdynamics {

const BallKernels BALL_KERNELS{sweepPacks, advanceBodies, rebuildPacks, certifyPacks};

} // namespace contactdynamics
