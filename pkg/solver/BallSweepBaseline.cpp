// SPDX-License-Identifier: GPL-2.0-or-later
#define BALL_SWEEP ballSweepBaseline
#define BODY_ADVANCE bodyAdvanceBaseline
#include "BallSweep.inl"
