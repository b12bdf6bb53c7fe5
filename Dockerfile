# environment: the packages, for scripts/env and as a base; the last stage: the program itself.
# Built by scripts/image, which gives another BASE where no registry answers.
ARG BASE=debian:trixie-slim

FROM ${BASE} AS environment
# a further list of packages: scripts/packages.$WITH
ARG WITH=
COPY scripts/packages* /usr/share/thermowear/
RUN apt-get update \
    && cd /usr/share/thermowear && sed 's/#.*//' packages ${WITH:+"packages.$WITH"} \
        | DEBIAN_FRONTEND=noninteractive xargs apt-get install --yes --no-install-recommends \
    && rm -rf /var/lib/apt/lists/* /var/cache/apt/*.bin

FROM environment
# Open MPI: as in scripts/env. HOME and the caches serve any user: docker run --user "$(id -u)".
ENV LANG=C.UTF-8 \
    PYTHONPATH=/opt/thermowear \
    HOME=/home/thermowear \
    XDG_CACHE_HOME=/home/thermowear/.cache \
    MPLCONFIGDIR=/home/thermowear/.cache/matplotlib \
    OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_btl=self,sm \
    PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe \
    PRTE_MCA_hwloc_default_binding_policy=none
COPY demos /opt/thermowear/demos
COPY thermowear /opt/thermowear/thermowear
# X sockets of Xvfb, which a user other than root cannot prepare
RUN python3 -m compileall -q /opt/thermowear/thermowear \
    && useradd --create-home thermowear \
    && install -d -m 1777 /tmp/.X11-unix /work
USER thermowear
WORKDIR /work
# The demos leave their compiled forms in the cache, so that a first run does not wait for gcc.
RUN for demo in annular_punch annular_punch_running_in; do \
        python3 -m thermowear run "/opt/thermowear/demos/$demo.toml" -o "/tmp/$demo" --no-pictures \
        || exit 1; \
    done \
    && rm -rf /tmp/annular_punch* \
    && chmod -R a+rwX /home/thermowear
ENTRYPOINT ["python3", "-m", "thermowear"]
CMD ["--help"]
