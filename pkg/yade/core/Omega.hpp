// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Math.hpp>
#include <lib/base/Singleton.hpp>
#include <lib/factory/ClassFactory.hpp>

#include <map>
#include <set>

namespace yade {

class Scene;

/// What YADE knows about a class from its plugin.
struct DynlibDescriptor {
	std::set<string> baseClasses;
	bool isSerializable;
};

/// The process-wide object behind Python's `O`.
class Omega : public Singleton<Omega> {
	alignas(8) abi::Opaque<0, 416> everything;

public:
	Omega() = delete;
	~Omega() = delete;

	const shared_ptr<Scene>& getScene() const;
	const std::map<string, DynlibDescriptor>& getDynlibsDescriptor() const;
	/// Registers the classes waiting in ClassFactory::pluginClasses, after opening the given libraries.
	void loadPlugins(vector<string> libraries);
	bool isInheritingFrom(const string& className, const string& baseClassName);
	bool isInheritingFrom_recursive(const string& className, const string& baseClassName);
};

} // namespace yade
