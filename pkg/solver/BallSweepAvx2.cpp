// SPDX-License-Identifier: GPL-2.0-or-later
// Compiled with -mavx2 (but without fused multiply-add, which would change the bits); called only where the processor has it.
#define BALL_SWEEP ballSweepAvx2
#define BODY_ADVANCE bodyAdvanceAvx2
#define BALL_REBUILD ballRebuildAvx2
#define BALL_CERTIFY ballCertifyAvx2
#include "BallSweep.inl"

#include "BallCertificate.inl"
