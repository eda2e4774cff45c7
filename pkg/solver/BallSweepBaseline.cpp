// SPDX-License-Identifier: GPL-2.0-or-later
#define BALL_SWEEP ballSweepBaseline
#include "BallSweep.inl"
