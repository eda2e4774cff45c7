// SPDX-License-Identifier: GPL-2.0-or-later
#include "DeferredError.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <boost/weak_ptr.hpp>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace yade {
namespace {
struct Report {
	boost::weak_ptr<Scene> owner; // another scene may have the address of one that is gone
	long iter;
	std::pair<int, int> ids;
	std::string message;

	/// A report of which no engine asked remains until then.
	bool isOf(const Scene& scene) const { return owner.lock().get() == &scene && iter == scene.iter; }
};
std::mutex reportsGuard;
std::map<const Scene*, Report> reports; // almost always empty
} // namespace

void DeferredError::report(const Scene* scene, int id1, int id2, const std::string& message)
{
	const std::lock_guard<std::mutex> lock(reportsGuard);
	const std::pair<int, int> ids(id1, id2);
	const auto known = reports.find(scene);
	if (known == reports.end() || !known->second.isOf(*scene) || ids < known->second.ids)
		reports[scene] = {Omega::instance().getScene(), scene->iter, ids, message};
}

void DeferredError::raise(const Scene* scene)
{
	const std::lock_guard<std::mutex> lock(reportsGuard);
	const auto known = reports.find(scene);
	if (known == reports.end()) return;
	const Report report = known->second;
	reports.erase(known);
	if (report.isOf(*scene)) throw std::runtime_error(report.message);
}

} // namespace yade
