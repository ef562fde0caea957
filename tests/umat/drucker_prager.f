C     Drucker-Prager without volume change after yield: PROPS are E, nu,
C     c and phi (degrees); the cone of triaxial compression.  Beyond the
C     apex the mean stress stays elastic and the deviator goes.  A fifth
C     property of 1: DDSDDE stays elastic.
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,RPL,DDSDDT,
     1 DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,
     2 CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     3 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),STATEV(NSTATV),DDSDDE(NTENS,NTENS),
     1 DDSDDT(NTENS),DRPLDE(NTENS),STRAN(NTENS),DSTRAN(NTENS),TIME(2),
     2 PREDEF(1),DPRED(1),PROPS(NPROPS),COORDS(3),DROT(3,3),
     3 DFGRD0(3,3),DFGRD1(3,3)
      DIMENSION S(6),UNIT(6),XN(6)
      G=PROPS(1)/(2.D0*(1.D0+PROPS(2)))
      BULK=PROPS(1)/(3.D0*(1.D0-2.D0*PROPS(2)))
      PHI=PROPS(4)*3.14159265358979323846D0/180.D0
      DENOM=SQRT(3.D0)*(3.D0-SIN(PHI))
      ALPHA=2.D0*SIN(PHI)/DENOM
      COHE=6.D0*PROPS(3)*COS(PHI)/DENOM
      PMAX=1.D300
      IF (ALPHA.GT.0.D0) PMAX=COHE/(3.D0*ALPHA)
      VOL=0.D0
      DO I=1,NTENS
        UNIT(I)=0.D0
        IF (I.LE.NDI) UNIT(I)=1.D0
        IF (I.LE.NDI) VOL=VOL+DSTRAN(I)
      END DO
C     Elastic trial, its mean stress and the root of J2.
      P=0.D0
      DO I=1,NTENS
        IF (I.LE.NDI) THEN
          STRESS(I)=STRESS(I)+BULK*VOL+2.D0*G*(DSTRAN(I)-VOL/3.D0)
          P=P+STRESS(I)/3.D0
        ELSE
          STRESS(I)=STRESS(I)+G*DSTRAN(I)
        END IF
      END DO
      Q=0.D0
      DO I=1,NTENS
        S(I)=STRESS(I)-P*UNIT(I)
        IF (I.LE.NDI) Q=Q+0.5D0*S(I)**2
        IF (I.GT.NDI) Q=Q+S(I)**2
      END DO
      Q=SQRT(Q)
      F=Q+3.D0*ALPHA*P-COHE
      SMALL=1.D-12*(COHE+3.D0*ALPHA*ABS(P)+Q)
      THETA=1.D0
      TURN=0.D0
      PUSH=0.D0
      IF (F.GT.SMALL.AND.P.LE.PMAX+SMALL) THEN
        THETA=MAX(COHE-3.D0*ALPHA*P,0.D0)/Q
        TURN=-2.D0*G*THETA
        PUSH=3.D0*SQRT(2.D0)*BULK*ALPHA
      ELSE IF (P.GT.PMAX+SMALL) THEN
        THETA=0.D0
      END IF
      DO I=1,NTENS
        XN(I)=0.D0
        IF (Q.GT.0.D0) XN(I)=S(I)/(SQRT(2.D0)*Q)
        STRESS(I)=THETA*S(I)+P*UNIT(I)
      END DO
      IF (NPROPS.GE.5) THEN
        IF (PROPS(5).EQ.1.D0) THEN
          THETA=1.D0
          TURN=0.D0
          PUSH=0.D0
        END IF
      END IF
      DO J=1,NTENS
        DO I=1,NTENS
          D=BULK*UNIT(I)*UNIT(J)-2.D0*G*THETA*UNIT(I)*UNIT(J)/3.D0
          IF (I.EQ.J.AND.I.LE.NDI) D=D+2.D0*G*THETA
          IF (I.EQ.J.AND.I.GT.NDI) D=D+G*THETA
          DDSDDE(I,J)=D+TURN*XN(I)*XN(J)-PUSH*XN(I)*UNIT(J)
        END DO
      END DO
      RETURN
      END
