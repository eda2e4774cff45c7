// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

/// The one instance of a class, kept in libyade. Declared and not defined, so that this library never makes a second one.
template <class T> class Singleton {
protected:
	static T* self;

public:
	static T& instance();
};
