// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace boost::python {
}

namespace yade {
namespace py = ::boost::python;
}
