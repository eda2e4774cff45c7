// SPDX-License-Identifier: GPL-2.0-or-later
#define BALL_SWEEP ballSweepBaseline
#define BODY_ADVANCE bodyAdvanceBaseline
#define BALL_REBUILD ballRebuildBaseline
#define BALL_CERTIFY ballCertifyBaseline
#include "BallSweep.inl"

#include "BallCertificate.inl"
