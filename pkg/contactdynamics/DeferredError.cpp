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

	/// A report of which no engine asked remains until then. A scene that is not the current one, but running still, is told by its address alone.
	bool isOf(const Scene& scene) const { return (owner.empty() || owner.lock().get() == &scene) && iter == scene.iter; }
};
std::mutex reportsGuard;
std::map<const Scene*, Report> reports; // almost always empty

boost::weak_ptr<Scene> ownerOf(const Scene* scene)
{
	const shared_ptr<Scene>& current = Omega::instance().getScene();
	return current.get() == scene ? boost::weak_ptr<Scene>(current) : boost::weak_ptr<Scene>();
}
} // namespace

void DeferredError::report(const Scene* scene, int id1, int id2, const std::string& message)
{
	const std::lock_guard<std::mutex> lock(reportsGuard);
	const std::pair<int, int> ids(id1, id2);
	const auto known = reports.find(scene);
	if (known == reports.end() || !known->second.isOf(*scene) || ids < known->second.ids)
		reports[scene] = {ownerOf(scene), scene->iter, ids, message};
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
