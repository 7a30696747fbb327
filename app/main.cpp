#include <lamella/lamella.hpp>

int main() {
    return 0;
}
