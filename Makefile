# The short way to everything. Each target works on a Debian 12 that has only git, make, and root or sudo; the
# build itself is CMake's (CMakePresets.json).

PREFIX ?= /usr/local
JOBS := $(shell nproc)
# One more than there are processors: some tests mostly wait.
CTEST := ctest --output-on-failure --no-tests=error --parallel $(shell expr $(JOBS) + 1)
MODULES := core mesh parts contour slicing polygon scan system container read raster write pipeline
blank := $(subst ,, )
SOURCES = $(shell find app bench examples include parts python src tests -name '*.[ch]pp' 2>/dev/null)

# Where nothing was built before, the sources of a module are compiled together: in two thirds of the time.
ifeq ($(wildcard build/CMakeCache.txt),)
RELEASE := -D CMAKE_UNITY_BUILD=ON
endif

# A compiler cache is used where there is one, for the same sources in another folder and with messages in another language, too.
ifneq ($(shell command -v ccache),)
export CMAKE_CXX_COMPILER_LAUNCHER := ccache
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_SLOPPINESS := locale
endif

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

packages:  ## install the Debian packages that building and testing need
	@tools/install_packages.sh tools/packages.txt tools/packages-test.txt

packages-viewer:
	@tools/install_packages.sh tools/packages.txt tools/packages-viewer.txt

build: packages  ## build the program, build/lamella, and the Python package, build/python
	cmake --preset release $(RELEASE)
	cmake --build build --target lamella_programs lamella_python_package

# Of all there is, the program alone is built, in the quickest way.
demo:  ## make, slice and verify two parts; slice files, pictures and a page are left in out/
	@echo "Installing what is missing and building the program: about three minutes the first time."
	@tools/install_packages.sh tools/packages.txt tools/packages-viewer.txt
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=OFF
	cmake --build build --target lamella_app
	@python3 tools/demo.py build/lamella out

# TESTS are options of ctest, for some of the tests.
test: packages  ## build everything and run the tests: a few minutes
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D LAMELLA_LARGE_TESTS=OFF
	cmake --build build
	@rm -f build/tests/passed
	$(CTEST) --test-dir build $(TESTS)
	$(if $(TESTS),,@touch build/tests/passed)

test-all: test-large test-asan test-tsan test-arm64 test-shared fresh  ## the long suites: large programs, sanitizers, ARM64, fresh

# Each of these is a part of test-all.
packages-all: packages packages-viewer
	@tools/install_packages.sh tools/packages-all.txt tools/packages-dist.txt tools/packages-docs.txt

test-large: packages-all
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D LAMELLA_LARGE_TESTS=ON
	cmake --build build
	$(CTEST) --test-dir build --label-regex large

test-asan: packages-all
	cmake --preset asan-ubsan
	cmake --build build-asan
	$(CTEST) --test-dir build-asan --label-exclude '^(bench|project|viewer)$$'

test-tsan: packages-all
	cmake --preset tsan
	cmake --build build-tsan --target $(MODULES:%=lamella_%_test)
	$(CTEST) --test-dir build-tsan --label-regex '^($(subst $(blank),|,$(MODULES)))$$'

# The modules that compute, and the bodies that these are tried on.
test-arm64: packages-all
	@tools/install_packages.sh tools/packages-arm64.txt
	cmake --preset arm64
	cmake --build build-arm64
	$(CTEST) --test-dir build-arm64

# What was compiled for the static library serves the shared one, which differs by how it is installed and linked. Compilers
# differ in what visibility holds for.
test-shared: packages-all
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D BUILD_SHARED_LIBS=ON
	cmake --build build --target lamella_programs lamella_app_files
	$(CTEST) --test-dir build --tests-regex '^project.install$$'
	cmake --preset shared-clang
	cmake --build build-shared-clang --target lamella_app lamella_app_files
	$(CTEST) --test-dir build-shared-clang --tests-regex '^project.install$$'

fresh:  ## `make demo` and `make test` on a Debian 12 with git, make and nothing else, made for it (root only)
	@tools/fresh.sh

fuzz: packages-all  ## fuzz readers and strategies, each for MINUTES (10 unless given); what is found is left in out/fuzz/
	cmake --preset fuzz
	cmake --build build-fuzz --target tests/fuzz/all
	$(CTEST) --test-dir build-fuzz --label-regex '^fuzz$$'
	tests/fuzz/fuzz.sh build-fuzz/tests/fuzz out/fuzz $(MINUTES)

bench: packages  ## build and run the benchmarks (bench/README.md)
	@tools/install_packages.sh tools/packages-bench.txt
	cmake --preset bench
	cmake --build build-bench
	build-bench/bench/limit
	build-bench/bench/growth
	build-bench/bench/files
	build-bench/bench/raster
	build-bench/bench/layer_steps
	build-bench/bench/scan
	build-bench/bench/small_parts
	build-bench/bench/hostile_layers
	build-bench/bench/kernels

scaling: build  ## bytes and seconds of lamella-mpi, measured and predicted: out/scaling/ (bench/README.md)
	python3 -B -m bench.scaling $(OPTIONS)

soak: build  ## random good and bad files through the batch mode, for ten minutes (bench/README.md)
	python3 -B -m bench.soak $(OPTIONS)

# The comparisons need other people's programs, and run for an hour or more in full; see bench/README.md for options.
packages-rivals: packages
	@tools/install_packages.sh tools/packages-bench.txt tools/packages-rivals.txt

rivals: build packages-rivals  ## compare with other slicers on the same parts: out/rivals/ (bench/README.md)
	cmake --preset bench
	cmake --build build-bench --target lamella_cgal_slicer
	python3 -B -m bench.rivals $(OPTIONS)

broken: build packages-rivals  ## compare with other slicers on broken meshes: out/broken/ (bench/README.md)
	python3 -B -m bench.broken $(OPTIONS)

read-meshes: build packages-rivals  ## compare with other readers of meshes: out/read_meshes/ (bench/README.md)
	cmake --preset bench
	cmake --build build-bench --target bench/read_meshes/all
	python3 -B -m bench.read_meshes $(OPTIONS)

resin: build packages-rivals  ## compare pictures for resin printers with PrusaSlicer's: out/resin/ (bench/README.md)
	python3 -B -m bench.resin $(OPTIONS)

out-of-core: build  ## slice a lattice of 5 GB with 1 GB of memory: out/out_of_core/ (bench/README.md)
	@tools/install_packages.sh tools/packages-bench.txt
	cmake --preset bench
	cmake --build build-bench --target lamella_stream_areas
	python3 -B -m bench.out_of_core $(OPTIONS)

python-bench: build packages-rivals  ## compare with other ways to slice in Python: out/python/ (bench/README.md)
	cmake --preset bench
	cmake --build build-bench --target lamella_library_slicer lamella_cgal_slicer
	python3 -B -m bench.python $(OPTIONS)

page-bench: packages-viewer build  ## how soon pages show something in a browser: out/pages/ (bench/README.md)
	@tools/install_packages.sh tools/packages-all.txt
	python3 -B -m bench.pages $(OPTIONS)

paper: build packages-rivals  ## measure every table of the EECC paper again: out/paper/ (bench/README.md)
	python3 -B -m bench.paper $(OPTIONS)

# Debian's packages belong to Debian's interpreter, whichever comes first in the path.
docs: build  ## build the documentation site: out/site/
	@tools/install_packages.sh tools/packages-docs.txt
	/usr/bin/python3 -B tools/site/build_site.py build out/site

format:  ## lay out the sources by .clang-format
	@tools/install_packages.sh tools/packages-lint.txt
	@clang-format -i $(SOURCES)

format-check:  ## fail where `make format` would change something
	@tools/install_packages.sh tools/packages-lint.txt
	@clang-format --dry-run --Werror $(SOURCES)

lint: packages  ## static analysis by .clang-tidy
	@tools/install_packages.sh tools/packages-lint.txt
	cmake --preset debug
	run-clang-tidy -quiet -j $(JOBS) -p build-debug

install: build  ## install to PREFIX (default /usr/local)
	cmake --build build --target lamella_app_files
	cmake --install build --prefix '$(PREFIX)'

dist: packages-viewer build  ## what is released, into dist/: source archive, Debian package, wheel
	@tools/install_packages.sh tools/packages-dist.txt
	cmake --build build --target lamella_app_files
	tools/dist.sh build dist

clean:  ## remove what was built
	rm -rf build build-* dist out

.NOTPARALLEL:
.PHONY: help packages packages-viewer build demo test test-all packages-all test-large test-asan test-tsan \
        test-arm64 test-shared fresh fuzz bench scaling soak docs packages-rivals rivals broken read-meshes resin \
        out-of-core python-bench page-bench paper format format-check lint install dist clean
