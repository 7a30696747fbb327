# Entry points for common work. Each target works on a Debian 12 that has only git, make, and root or sudo; CMake does
# the build itself (CMakePresets.json).

PREFIX ?= /usr/local
JOBS := $(shell nproc)
# One more than the number of processors: some tests mostly wait.
CTEST := ctest --output-on-failure --no-tests=error --parallel $(shell expr $(JOBS) + 1)
VERSION := $(shell sed -n 's/^\#define LAMELLA_VERSION "\(.*\)"/\1/p' include/lamella/core/version.hpp)
MODULES := core mesh parts contour slicing polygon scan findings system container raster meshes slices inputs jobs c
blank := $(subst ,, )
SOURCES = $(shell find app bench examples include parts python src tests viewer web -name '*.[ch]pp' 2>/dev/null)

# The first build of a tree compiles the sources of a module together, which takes two thirds of the time.
ifeq ($(wildcard build/CMakeCache.txt),)
RELEASE := -D CMAKE_UNITY_BUILD=ON
endif

# A compiler cache is used if there is one; it also serves the same sources in another folder and messages in another
# language.
ifneq ($(shell command -v ccache),)
export CMAKE_CXX_COMPILER_LAUNCHER := ccache
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_SLOPPINESS := locale
endif

help:  ## print this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

packages:  ## install the Debian packages that building and testing need
	@tools/install_packages.sh tools/packages.txt tools/packages-test.txt

packages-viewer:
	@tools/install_packages.sh tools/packages.txt tools/packages-viewer.txt

build: packages  ## build the program, build/lamella, and the Python package, build/python
	cmake --preset release $(RELEASE)
	cmake --build build --target lamella_programs lamella_python_package

# Builds only the program, in the quickest configuration.
demo:  ## make, slice and verify two parts; writes slice files, images and a page to out/
	@echo "Installing what is missing and building the program: about three minutes the first time."
	@tools/install_packages.sh tools/packages.txt tools/packages-viewer.txt
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=OFF
	cmake --build build --target lamella_app
	@python3 tools/demo.py build/lamella out

# $(call suites,FOLDER,SUITES,LABELS) builds suites in a build folder, and runs them and what else has these labels. A
# suite is a folder of tests/; its name is the label of its tests.
define suites
cmake --build $(1) --target $(patsubst %,tests/%/all,$(2))
$(CTEST) --test-dir $(1) --label-regex '^($(subst $(blank),|,$(strip $(2) $(3))))$$'
endef

# TESTS are options of ctest that select tests.
test: packages  ## build everything and run the tests: a few minutes
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D LAMELLA_LARGE_TESTS=OFF
	cmake --build build
	@rm -f build/tests/passed
	$(CTEST) --test-dir build $(TESTS)
	$(if $(TESTS),,@touch build/tests/passed)

# `make test`, and of each other build the suites that find what no other finds. .ci/run runs two parts at a time.
test-ci: packages-ci test ci-asan ci-tsan ci-windows ci-web  ## run `make test`, and the tests of memory, threads, Windows and web of CI

packages-ci:
	@tools/install_packages.sh tools/packages.txt $(patsubst %,tools/packages-%.txt,test viewer ci web windows)

ci-asan: packages-ci
	cmake --preset asan-ubsan
	cmake --build build-asan --target lamella_app lamella_processor_test
	$(call suites,build-asan,container meshes slices inputs fuzz,processor input)

# Of the engine alone, which takes a third of the time to compile. test-tsan has the rest.
ci-tsan: packages-ci
	cmake --preset tsan -D LAMELLA_IO=OFF
	$(call suites,build-tsan,core slicing polygon)

# Optimised less, since that compiles in half the time. The output is compared with that of build/lamella.
ci-windows: packages-windows
	cmake --preset windows -D LAMELLA_TESTS=ON -D CMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG'
	cmake --build build-windows --target lamella_app tests/app/all
	$(call suites,build-windows,system,processes)

ci-web: packages-ci web
	tests/web/run.sh build api_test.mjs preview_test.mjs package_test.mjs browser_test.mjs

test-all: test-large test-asan test-tsan test-arm64 test-windows test-macos test-shared test-web fresh  ## run the long suites: large programs, sanitizers, ARM64, Windows, macOS, web, fresh

# The targets from here to `fresh` are parts of test-all.
packages-all: packages-ci
	@tools/install_packages.sh tools/packages-all.txt tools/packages-dist.txt tools/packages-docs.txt

test-large: packages-all
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D LAMELLA_LARGE_TESTS=ON
	cmake --build build
	$(CTEST) --test-dir build --label-regex large

test-asan: packages-all
	cmake --preset asan-ubsan
	cmake --build build-asan
	$(CTEST) --test-dir build-asan --label-exclude '^(bench|project|viewer)$$'

test-tsan: packages-ci
	cmake --preset tsan -D LAMELLA_IO=ON
	$(call suites,build-tsan,$(MODULES))

# Tests the modules that compute, and the test bodies they use.
test-arm64: packages-all
	@tools/install_packages.sh tools/packages-arm64.txt
	cmake --preset arm64
	cmake --build build-arm64
	$(CTEST) --test-dir build-arm64

packages-windows: packages-viewer
	@tools/install_packages.sh tools/packages-windows.txt
	@tools/build_libraries.sh mingw

# The playground is in the archive of the program if `make web` has built it.
windows: packages-windows  ## build the program and the libraries for Windows: two zip archives in build-windows/
	cmake --preset windows -D LAMELLA_TESTS=OFF
	cmake --build build-windows --target lamella lamella-io lamella-c lamella_app lamella_app_files
	@rm -rf build-windows/package
	cmake --install build-windows --strip --prefix build-windows/package >/dev/null
	/usr/bin/python3 -B tools/windows/make_archives.py build-windows/package build-windows/app/lamella.ps1 \
	    build/web/playground.html $(VERSION) build-windows
	python3 -B tests/project/windows_archives_test.py build-windows

# Built here, not run: the workflow runs the tests on macOS. The program for this system prints the man page and the
# completions.
macos: packages-viewer build  ## build the program and the libraries for macOS: archives in build-macos-*/
	@tools/install_packages.sh tools/packages-zig.txt
	cmake --build build --target lamella_app_files
	@tools/install_zig.sh
	@test ! -x .cache/zig/zig || $(MAKE) --no-print-directory macos-arm64 macos-x86_64

macos-arm64 macos-x86_64:
	@tools/build_libraries.sh $@
	cmake --preset $@
	cmake --build build-$@ --target lamella lamella-io lamella_app
	cp build/app/lamella.1 build/app/lamella.bash build/app/_lamella build/app/lamella.fish build/app/lamella.ps1 build-$@/app/
	@rm -rf build-$@/package
	cmake --install build-$@ --prefix build-$@/package >/dev/null
	cd build-$@/package && cmake -E tar czf ../lamella-$(VERSION)-$@.tar.gz --format=gnutar .
	@ls -l build-$@/lamella build-$@/lamella-$(VERSION)-$@.tar.gz
	python3 -B tests/project/macos_test.py build-$@/lamella-$(VERSION)-$@.tar.gz

# Compiles the sources of the module `system`, of which some are for macOS only. The whole program takes too long here.
test-macos: packages-viewer
	@tools/install_packages.sh tools/packages-zig.txt
	@tools/install_zig.sh
	@test ! -x .cache/zig/zig || $(MAKE) --no-print-directory compile-macos

compile-macos:
	@tools/build_libraries.sh macos-arm64
	cmake --preset macos-arm64
	cmake --build build-macos-arm64 --target src/CMakeFiles/lamella-io.dir/Unity/unity_system_cxx.cxx.o \
	    src/CMakeFiles/lamella_system_of_programs.dir/Unity/unity_0_cxx.cxx.o

# For Debian's version of Python, or that of PYTHON. The tests run the wheel for ARM64 in an emulator.
PYTHON := /usr/bin/python3
wheels: packages-viewer build  ## build wheels of the Python package for Linux with glibc 2.28 and test them: build/wheels/
	@tools/install_packages.sh tools/packages-zig.txt tools/packages-dist.txt tools/packages-wheels.txt
	@tools/install_zig.sh
	@rm -rf build/wheels
	@test ! -x .cache/zig/zig || PYTHON='$(PYTHON)' tools/wheels.sh build/wheels
	@test ! -x .cache/zig/zig || $(PYTHON) -B tests/project/wheels_test.py build build/wheels

# The program's output is compared with that of the program for this system.
test-windows: packages-windows build
	cmake --preset windows -D LAMELLA_TESTS=ON
	cmake --build build-windows
	$(CTEST) --test-dir build-windows

# The shared library reuses the objects of the static one; only installation and linking differ. Two compilers are
# tested, since they apply visibility to different entities.
test-shared: packages-all
	cmake --preset release $(RELEASE) -D LAMELLA_TESTS=ON -D BUILD_SHARED_LIBS=ON
	cmake --build build --target lamella_programs lamella_app_files
	$(CTEST) --test-dir build --label-regex '^install$$'
	cmake --preset shared-clang
	cmake --build build-shared-clang --target lamella_app lamella_app_files
	$(CTEST) --test-dir build-shared-clang --label-regex '^install$$'

fresh:  ## run `make demo` and `make test` in a fresh Debian 12 with git, make and nothing else (root only)
	@tools/fresh.sh

# Debian's Emscripten looks for the modules of its JavaScript optimiser here, and would use clang 14, whose exceptions are
# not safe for threads: data between a throw and its catch is shared by all threads.
web: export NODE_PATH := /usr/share/nodejs
web: export EM_LLVM_ADD_VERSION := 15
web: export EM_CLANG_ADD_VERSION := 15
web: packages packages-viewer  ## build the npm package and the playground: build/web/package, build/web/playground.html
	@tools/install_packages.sh tools/packages-web.txt
	tools/build_libraries.sh wasm
	cmake --preset web
	cmake --build build-web --target lamella_playground

test-web: web build packages-all
	tests/web/run.sh build api_test.mjs preview_test.mjs package_test.mjs layer_hashes_test.mjs browser_test.mjs sample_test.mjs

fuzz: packages-all  ## fuzz readers and strategies, each for MINUTES (default 10); writes findings to out/fuzz/
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
	build-bench/bench/light_meshes
	build-bench/bench/kernels

scaling: build  ## measure and predict bytes and seconds of lamella-mpi: out/scaling/ (bench/README.md)
	python3 -B -m bench.scaling $(OPTIONS)

soak: build  ## slice random good and bad files in batch mode for ten minutes (bench/README.md)
	python3 -B -m bench.soak $(OPTIONS)

# The comparisons need third-party programs, and a full one takes an hour or more; see bench/README.md for options.
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

resin: build packages-rivals  ## compare images for resin printers with PrusaSlicer's: out/resin/ (bench/README.md)
	python3 -B -m bench.resin $(OPTIONS)
	/usr/bin/python3 -B -m bench.resin.voxels

out-of-core: build  ## slice a lattice of 5 GB with 1 GB of memory: out/out_of_core/ (bench/README.md)
	@tools/install_packages.sh tools/packages-bench.txt
	cmake --preset bench
	cmake --build build-bench --target lamella_stream_areas
	python3 -B -m bench.out_of_core $(OPTIONS)

python-bench: build packages-rivals  ## compare with other slicers in Python: out/python/ (bench/README.md)
	cmake --preset bench
	cmake --build build-bench --target lamella_library_slicer lamella_cgal_slicer
	python3 -B -m bench.python $(OPTIONS)

cores: packages  ## measure jobs with one thread and with all: out/cores/ (bench/README.md)
	@tools/install_packages.sh tools/packages-bench.txt
	cmake --preset bench
	cmake --build build-bench --target lamella_bench_cores
	python3 -B -m bench.cores $(OPTIONS)

page-bench: packages-viewer build  ## measure the time until pages show something in a browser: out/pages/ (bench/README.md)
	@tools/install_packages.sh tools/packages-ci.txt
	python3 -B -m bench.pages $(OPTIONS)

web-bench: web build  ## compare the npm package with the program and manifold-3d: out/web/ (bench/README.md)
	@tools/install_packages.sh tools/packages-all.txt
	python3 -B -m bench.web $(OPTIONS)

paper: build packages-rivals  ## measure every table of the EECC paper again: out/paper/ (bench/README.md)
	python3 -B -m bench.paper $(OPTIONS)

# Debian's packages work only with Debian's interpreter, which need not be the first in the path.
docs: build web  ## build the documentation site: out/site/
	@tools/install_packages.sh tools/packages-docs.txt
	/usr/bin/python3 -B tools/site/build_site.py build out/site build/web/playground.html

format:  ## format the sources by .clang-format
	@tools/install_packages.sh tools/packages-lint.txt
	@clang-format -i $(SOURCES)

format-check:  ## fail if `make format` would change something
	@tools/install_packages.sh tools/packages-lint.txt
	@clang-format --dry-run --Werror $(SOURCES)

lint: packages  ## run static analysis by .clang-tidy
	@tools/install_packages.sh tools/packages-lint.txt
	cmake --preset debug
	run-clang-tidy -quiet -j $(JOBS) -p build-debug

install: build  ## install to PREFIX (default /usr/local)
	cmake --build build --target lamella_app_files
	cmake --install build --prefix '$(PREFIX)'

dist: packages-viewer build  ## make the files of a release in dist/: source archive, Debian package, wheel
	@tools/install_packages.sh tools/packages-dist.txt
	cmake --build build --target lamella_app_files
	tools/dist.sh build dist

clean:  ## remove all build and output folders
	rm -rf build build-* dist out

.NOTPARALLEL:
.PHONY: help packages packages-viewer packages-windows windows test-windows macos macos-arm64 macos-x86_64 test-macos \
        compile-macos wheels build demo test test-ci packages-ci ci-asan ci-tsan ci-windows ci-web test-all packages-all \
        test-large test-asan test-tsan test-arm64 test-shared web test-web fresh fuzz bench scaling soak docs \
        packages-rivals rivals broken read-meshes resin out-of-core python-bench cores page-bench web-bench paper format \
        format-check lint install dist clean
