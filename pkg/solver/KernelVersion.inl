// SPDX-License-Identifier: GPL-2.0-or-later
// One version of the kernels, WIDE_LANES wide, as CONTACT_KERNELS.
#include "BallCertificate.inl"
#include "BallSweep.inl"
#include "GeneralCertificate.inl"
#include "GeneralSweep.inl"

namespace contactdynamics {

const ContactKernels CONTACT_KERNELS{advanceBodies,		sweepPacks,			 rebuildPacks,		 certifyPacks,
									 sweepGeneralPacks, rebuildGeneralPacks, certifyGeneralPacks};

} // namespace contactdynamics
