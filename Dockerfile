# hexpipe in a container, built by the script that builds it elsewhere. The slim image leaves out man pages and documentation.
#
#   docker build -t hexpipe .
#   docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/work" hexpipe hexpipe bracket.stl --size 3 -o bracket.msh
FROM debian:12 AS build
WORKDIR /hexpipe
COPY . .
RUN ./bootstrap.sh && apt-get install -y --no-install-recommends dpkg-dev file && cd build && cpack

FROM debian:12-slim
COPY --from=build /hexpipe/build/*.deb /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/*.deb && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /work
