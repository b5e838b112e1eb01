#include <hgmm/map.h>

#include <iostream>

int main() {
    hgmm::Scan scan;
    for (int i = 0; i < 100; ++i)
        scan.pushBack(3.F, 0.01F * float(i % 10), 0.01F * float(i / 10));
    hgmm::Map map;
    map.insert(scan);
    std::cout << "consumer-core: " << map.mixture().size() << " component(s)\n";
}
