// SPDX-License-Identifier: GPL-2.0-or-later
// The kernels of BallSweep.inl and BallCertificate.inl as BALL_KERNELS.
#include "BallKernels.hpp"

namespace contactdynamics {

const BallKernels BALL_KERNELS{sweepPacks, advanceBodies, rebuildPacks, certifyPacks};

} // namespace contactdynamics
