# noqa: A005 - tests mirror src
